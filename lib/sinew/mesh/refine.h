// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes that bend better: the same surface in smaller triangles, as a skin bends no finer than its
// points, and a layer along a surface that has no inside.
//
//     const Triangles skin = refined(surface.triangles, 0.01);
//     const Triangles slab = thickened(sheet.triangles, 0.02);
//     write_file("slab.obj", obj_text(slab));
#pragma once

#include <array>
#include <string>
#include <vector>

#include <sinew/core/triangles.h>

namespace sinew {

// Smaller triangles.

/// The longest side of any triangle, m; 0 without faces.
double longest_side(const Triangles& surface);

/// Halves all sides longer than `longest` (m, > 0) until there is none. A face is cut into two,
/// three or four by its long sides; both faces of a side get the same new point, so that what was
/// closed stays closed. The points stay, in their order, and new ones follow; faces keep their
/// planes and orientation. Accepts any triangles. The number of faces goes with their area over the
/// square of `longest`, and with the length of needles over it, which are cut across at once.
///
/// Needles stay needles: it cuts sides and moves no point. `ends`, where given, receives for each
/// new point the two earlier ones that it lies midway between.
Triangles refined(Triangles surface, double longest,
                  std::vector<std::array<int, 2>>* ends = nullptr);

// A layer.

/// Both sides of the surface, `thickness` (m) apart along the normals of its points, joined along
/// its border. Closed where no edge has three faces or more; cuts itself where the surface bends
/// more sharply than the layer is thick.
Triangles thickened(const Triangles& surface, double thickness);

/// Returns the text of an OBJ file: points in m, without loss, then faces. read_surface() gives the
/// same points and faces, in their order, where no point or face is twice in it.
std::string obj_text(const Triangles& surface);

}  // namespace sinew
