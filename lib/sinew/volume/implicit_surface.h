// SPDX-License-Identifier: GPL-3.0-or-later
// The surface where a distance is zero, by isosurface stuffing (Labelle and Shewchuk 2007) of a
// closest packing's honeycomb: edges that cross it are cut there, and none is cut near an end.
//
//     const Triangles ball = implicit_surface(
//         [](const Vec3& p) { return p.norm() - 1; }, Box(Vec3(-1, -1, -1), Vec3(1, 1, 1)), 0.1);
#pragma once

#include <functional>

#include <sinew/core/triangles.h>

namespace sinew {

/// Distance of a point (m) from a surface, negative inside, m.
using DistanceOf = std::function<double(const Vec3& point)>;

/// The surface of all that is inside the box, closed and outward; empty where nothing is. Points
/// lie on it; faces have edges of about `edge` (m, > 0), and no edge spans a gap wider than 1.42
/// times that. The same for any number of threads, in which the distance is evaluated.
Triangles implicit_surface(const DistanceOf& distance, const Box& box, double edge);

}  // namespace sinew
