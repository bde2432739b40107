// SPDX-License-Identifier: GPL-3.0-or-later
// Closest packing of equal spheres (FCC and HCP): what holds for both, for spheres of radius r.
#pragma once

#include <numbers>

namespace sinew {

/// Distance of nearest neighbours, d0 = 2r. Each inner particle has 12 of them.
constexpr double nearest_distance(double r) { return 2 * r; }

/// Distance of the 6 second neighbours, 2 sqrt(2) r.
constexpr double second_distance(double r) { return 2 * std::numbers::sqrt2 * r; }

/// Distance between the half-planes of FCC along a cube axis, sqrt(2) r.
constexpr double half_plane_spacing(double r) { return std::numbers::sqrt2 * r; }

/// Volume per particle, V0 = 4 sqrt(2) r^3: the cell's, not the sphere's, which is 26 % less.
constexpr double volume_per_particle(double r) { return 4 * std::numbers::sqrt2 * r * r * r; }

/// A slab this thick holds particles wherever it lies: no place is farther than sqrt(2) r from the
/// nearest site.
constexpr double surely_filled_thickness(double r) { return 2 * std::numbers::sqrt2 * r; }

/// Pairs closer than this at rest are neighbours: between first (2r) and second (2.83r) shell.
constexpr double rest_neighbour_range(double r) { return 2.2 * r; }

}  // namespace sinew
