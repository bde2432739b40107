// SPDX-License-Identifier: GPL-3.0-or-later
// The same surface in smaller triangles: a skin bends no finer than its points.
//
//     const Triangles skin = refined(surface.triangles, 0.01);
#pragma once

#include <string>

#include <sinew/core/triangles.h>

namespace sinew {

/// The longest side of any triangle, m; 0 without faces.
double longest_side(const Triangles& surface);

/// Halves all sides longer than `longest` (m, > 0) until there is none. The points stay, new ones
/// follow; faces keep their planes and orientation, and meet as before.
Triangles refined(Triangles surface, double longest);

/// As the text of an OBJ file.
std::string obj_text(const Triangles& surface);

}  // namespace sinew
