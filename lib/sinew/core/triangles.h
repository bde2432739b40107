// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle surface: the body's skin. Triangles are counter-clockwise seen from outside.
//
//     const double enclosed = volume(surface), skin = area(surface);
#pragma once

#include <array>
#include <string>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

struct Triangles {
  Points points;                          ///< n x 3, m
  std::vector<std::array<int, 3>> faces;  ///< m x 3, indices into points
};

/// Enclosed volume, sum of a.(b x c)/6 about the box's center, m^3. Negative when inside out.
double volume(const Triangles& surface);

/// Total area of the faces, m^2.
double area(const Triangles& surface);

/// The box around all points, m.
Box bounds(const Points& points);

/// Unit normals at the points (n x 3), faces weighted by area; zero where no face has an area.
Points point_normals(const Triangles& surface);

// The unchecked contents of a mesh file: points, and polygons over them.

struct PolygonSoup {
  Points points;                           ///< n x 3, m
  std::vector<std::vector<int>> polygons;  ///< any number of corners each, indices into points
  std::string warning = {};                ///< about what was made of the file; "": nothing to say
};

}  // namespace sinew
