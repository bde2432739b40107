// SPDX-License-Identifier: GPL-3.0-or-later
// Fills a closed surface with equal particles in closest packing: every lattice site strictly
// inside becomes a particle. A site on the surface counts as outside. (Komiya and Tokoi fill their
// bodies so; which lattice, and where it lies, they leave open.)
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/particles.h"
#include "core/settings.h"
#include "fill/fill_report.h"
#include "mesh/surface.h"

namespace sinew {

struct PackOptions {
  Packing packing = Packing::fcc;
  std::optional<double> radius;  ///< m; either this
  std::optional<int> count;      ///< or about so many particles
  double density = 1000;         ///< kg/m^3
};

struct Filling {
  Particles particles;                  ///< at rest, by lattice rows; mass = density volume / count
  std::vector<std::int32_t> component;  ///< the body each particle lies in, from 0
  std::vector<std::int32_t> neighbours;  ///< how many others touch it; 12 within the body
  FillReport report;
};

/// The same particles for every number of threads. Throws Error (bad input) before it fills when
/// there would be too many particles for memory or for 32-bit ids, when the body holds less than
/// one, and when no site lies inside; all name a radius that fits.
Filling pack(const Surface& surface, const PackOptions& options);

/// The radius (m) at which a volume (m^3) holds about `count` particles: (V / (4 sqrt(2) N))^(1/3).
double radius_for_count(double volume, double count);

}  // namespace sinew
