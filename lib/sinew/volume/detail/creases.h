// SPDX-License-Identifier: GPL-3.0-or-later
// Points of the border near sharp edges of the surface are moved onto these, and one to each of its
// corners: cut cells alone would bevel them.
//
//     const std::vector<char> moved = snap_to_creases(body, border, space, radius);
#pragma once

#include <span>
#include <vector>

#include <sinew/volume/detail/border_fit.h>
#include <sinew/volume/detail/inside_space.h>
#include <sinew/volume/volume_cells.h>

namespace sinew {

/// Leaves points where a cell would become flat. Returns which points have moved. `radius` in m.
std::vector<char> snap_to_creases(VolumeCells& body, std::span<const BorderFace> border,
                                  const InsideSpace& space, double radius);

}  // namespace sinew
