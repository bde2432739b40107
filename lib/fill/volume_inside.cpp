// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/volume_inside.h"

#include <cmath>

#include "core/closest_packing.h"
#include "fill/filled_sites.h"

namespace sinew {

double radius_for_count(double volume, double count) {
  return std::cbrt(volume / count / volume_per_particle(1));
}

double volume_inside(const Surface& surface) {
  if (surface.closed()) return volume(surface.triangles);
  const Lattice lattice = coarse_lattice(bounds(surface.triangles.points));
  const InsideRuns inside = inside_runs(lattice, surface);
  return static_cast<double>(count_of(inside.runs)) * volume_per_particle(lattice.radius);
}

double ambiguous_share(const Surface& surface) {
  if (surface.closed()) return 0;
  return ambiguous_share(coarse_lattice(bounds(surface.triangles.points)), surface);
}

}  // namespace sinew
