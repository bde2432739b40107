// SPDX-License-Identifier: GPL-3.0-or-later
// Checks before and after filling, of surfaces and options that cannot be filled. All refusals
// throw Error (bad input) with the decisive number and the cure.
//
//     const double radius = wanted_radius(BodySpace(surface, options), options);
#pragma once

#include <sinew/fill/filled_sites.h>
#include <sinew/mesh/surface.h>

namespace sinew {

/// The radius (m) at which a volume (m^3) holds about `count` particles: (V / (4 sqrt(2) N))^(1/3).
double radius_for_count(double volume, double count);

struct Inside {
  double volume;  ///< m^3
  bool exact;     ///< enclosed by separate closed parts; else an estimate by a coarse filling
};

/// Where the winding number of a surface is above one half.
Inside volume_inside(const Surface& surface);

/// The fraction of points in a surface's box whose winding number differs by more than 0.1 from any
/// integer: 0 for closed surfaces, near 1 where there is no inside.
double ambiguous_fraction(const Surface& surface);

/// Above this fraction of ambiguous points a surface has no inside: open shells that can be filled
/// reach 0.64, random triangles have 0.77, a Moebius strip has 0.87.
inline constexpr double max_ambiguous = 0.7;

/// Refuses surfaces without an inside, unless a layer is to be filled. Returns the fraction of
/// ambiguous points.
double refuse_without_inside(const BodySpace& space, const PackOptions& options);

/// The radius by the options, m. Refuses one that needs more particles than memory or 32-bit ids
/// hold, and one for which less than one particle fits.
double wanted_radius(const BodySpace& space, const PackOptions& options);

/// For a filling without particles: the error names a radius that gives some, or reports that all
/// sites are too close to the surface.
[[noreturn]] void refuse_empty(const BodySpace& space, const PackOptions& options,
                               const FilledSites& filled);

/// Refuses more particles than memory or 32-bit ids hold, once their number is known.
void refuse_found(const FilledSites& filled, const PackOptions& options);

}  // namespace sinew
