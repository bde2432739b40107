// SPDX-License-Identifier: GPL-3.0-or-later
// Fills a surface with equal particles in closest packing: every lattice site strictly inside
// becomes a particle; a site on the surface counts as outside. (As Komiya and Tokoi fill their
// bodies; they do not specify the lattice and its placement.) Accepts any surface with an inside:
// open, overlapping, of single triangles; with a thickness even a sheet.
//
//     const Filling filling = pack(read_surface(body), {.radius = 0.01});
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <sinew/core/options.h>
#include <sinew/core/particles.h>
#include <sinew/fill/fill_report.h>
#include <sinew/mesh/surface.h>

namespace sinew {

struct PackOptions {
  Packing packing = Packing::fcc;
  int seed = 1;                          ///< seed of a random packing
  std::optional<double> radius;          ///< m; either this
  std::optional<int> count;              ///< or about this number of particles
  double density = 1000;                 ///< kg/m^3
  std::optional<Vec3> lattice_origin;    ///< position of a site, m; by default the box's center
  Mat3 lattice_axes = Mat3::Identity();  ///< axes as columns: a rotation
  Keep keep = Keep::center;
  double clearance = 0;             ///< minimal distance from the surface, m
  std::optional<double> thickness;  ///< fill a layer along the surface instead of its inside, m
  bool volume_shares = false;       ///< find Filling::volume_share; not of HCP
  bool verify = false;              ///< check every site against CGAL
};

struct Filling {
  Particles particles;                  ///< at rest, by lattice rows; mass = density volume / count
  std::vector<std::int32_t> component;  ///< the body that each particle is in, from 0
  std::vector<std::int32_t> neighbors;  ///< number of touching particles; 12 inside a lattice
  /// Volume of the body around each particle over that of one inside; empty: not asked for.
  std::vector<double> volume_share;
  /// Stiffness of each particle's material over the body's; empty: the same throughout.
  std::vector<double> stiffness;
  FillReport report;
};

/// The same particles for any number of threads. Throws Error (bad input) where an open surface is
/// to be verified, where there would be too many particles for memory or 32-bit ids or less than
/// one, where the surface has no inside (naming the fraction of ambiguous points), and where no
/// site lies inside; all name a radius that fits, or the option that helps.
Filling pack(const Surface& surface, const PackOptions& options);

/// The same of polygons, each three corners or more, indices of points (n x 3, m): cleaned first.
/// Throws Error (bad input) as check_soup() and clean() do too.
Filling fill(Points points, std::vector<std::vector<int>> polygons, const PackOptions& options);

}  // namespace sinew
