// SPDX-License-Identifier: GPL-3.0-or-later
// What cannot be filled, said before it is tried. All of these throw Error (bad input) with the
// number that decided and the cure.
#pragma once

#include <sinew/fill/filled_sites.h>
#include <sinew/mesh/surface.h>

namespace sinew {

// How much there is to fill, before it is filled.

/// The radius (m) at which a volume (m^3) holds about `count` particles: (V / (4 sqrt(2) N))^(1/3).
double radius_for_count(double volume, double count);

/// About the volume inside a surface, m^3: exact where that is what closed, separate parts enclose,
/// else from a coarse filling.
double volume_inside(const Surface& surface);

/// The share of places in a surface's box whose winding number is farther than 0.1 from any whole
/// number: 0 for closed surfaces, near 1 where there is no inside.
double ambiguous_share(const Surface& surface);

/// Above this share of ambiguous places a surface has no inside: open shells that still fill reach
/// 0.64, random triangles have 0.77, a Moebius strip has 0.87.
inline constexpr double most_ambiguous = 0.7;

/// Refuses surfaces without an inside, unless a layer is to be filled. Returns the share of
/// ambiguous places.
double refuse_without_inside(const BodySpace& space, const PackOptions& options);

/// The radius that the options ask for, m. Refuses one that needs more particles than memory or
/// 32-bit ids hold, and one of which less than one particle fits.
double wanted_radius(const BodySpace& space, const PackOptions& options);

/// When no site became a particle: names a radius at which some do, or says that all are too close
/// to the surface.
[[noreturn]] void refuse_empty(const BodySpace& space, const PackOptions& options,
                               const FilledSites& filled);

/// The same as for a wanted radius, once it is known how many particles there will be.
void refuse_found(const FilledSites& filled);

}  // namespace sinew
