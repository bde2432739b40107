// SPDX-License-Identifier: GPL-3.0-or-later
// Distances and winding numbers of many points about one surface, in parallel.
//
//     const std::vector<double> winding = winding_numbers(surface, points);
#pragma once

#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/mesh/surface.h>

namespace sinew {

/// Distance of each point from the nearest face, m, 0 or more. Throws bad input where no face has
/// an area.
std::vector<double> distances(const Triangles& surface, const Points& points);

/// Generalized winding number (Jacobson et al. 2013) of the surface about each point: the solid
/// angle of its faces over 4 pi, of a closed surface an integer. The fill takes as inside what is
/// above 1/2. Not-a-number closer to a face than 1e-10 of the surface's size. Time grows with the
/// faces of the caps, times the points.
std::vector<double> winding_numbers(const Surface& surface, const Points& points);

}  // namespace sinew
