// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons into triangles by cutting off ears. CGAL's inside test is silently wrong on quads.
#pragma once

#include <array>
#include <vector>

#include "core/vector.h"

namespace sinew {

/// The triangles of a polygon (indices into points, 3 corners or more), turning the same way. Ears
/// are looked for in the plane across its mean normal, and none without area is cut while another
/// can be. Throws Error (bad input) for non-convex polygons of more than 1,000 corners.
std::vector<std::array<int, 3>> triangulate(const std::vector<int>& polygon, const Points& points);

}  // namespace sinew
