// SPDX-License-Identifier: GPL-3.0-or-later
// Fills a surface with equal particles in closest packing: every lattice site strictly inside
// becomes a particle. A site on the surface counts as outside. (Komiya and Tokoi fill their bodies
// so; which lattice, and where it lies, they leave open.) Any surface will do as long as it has an
// inside: open, overlapping, of single triangles; with a thickness even a sheet.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <sinew/core/options.h>
#include <sinew/core/particles.h>
#include <sinew/fill/fill_report.h>
#include <sinew/mesh/surface.h>

namespace sinew {

// How a surface is to be filled.

struct PackOptions {
  Packing packing = Packing::fcc;
  std::optional<double> radius;          ///< m; either this
  std::optional<int> count;              ///< or about so many particles
  double density = 1000;                 ///< kg/m^3
  std::optional<Vec3> lattice_origin;    ///< where a site lies, m; by default in the box's middle
  Mat3 lattice_axes = Mat3::Identity();  ///< as columns: a rotation
  Keep keep = Keep::center;
  double clearance = 0;             ///< how far within, m
  std::optional<double> thickness;  ///< fill a layer along the surface instead of its inside, m
  bool verify = false;              ///< ask CGAL about every site
};

struct Filling {
  Particles particles;                  ///< at rest, by lattice rows; mass = density volume / count
  std::vector<std::int32_t> component;  ///< the body each particle lies in, from 0
  std::vector<std::int32_t> neighbors;  ///< how many others touch it; 12 within the body
  FillReport report;
};

/// The same particles for every number of threads. Throws Error (bad input) before it fills when
/// an open surface is to be verified, when there would be too many particles for memory or for
/// 32-bit ids, when the body holds less than one, when the surface has no inside (naming the share
/// of ambiguous places), and when no site lies inside; all name a radius that fits, or the option
/// that helps.
Filling pack(const Surface& surface, const PackOptions& options);

}  // namespace sinew
