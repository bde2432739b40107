// SPDX-License-Identifier: GPL-3.0-or-later
// Cells whose corners lie on a curved surface lack the volume between their faces and the surface:
// of a ball ten layers across 1.3 %. The border is moved outward, or inward where it is concave, by
// the mean of what is missing, so that its faces lie about the surface; plane faces stay.
//
//     fit_border(body, space, radius);
#pragma once

#include <sinew/volume/detail/inside_space.h>
#include <sinew/volume/volume_cells.h>

namespace sinew {

/// Faces of one cell alone, outward.
std::vector<std::array<std::uint32_t, 3>> border_of(const VolumeCells& body);

/// Leaves points where a cell would become flatter than others are. `radius` in m.
void fit_border(VolumeCells& body, const InsideSpace& space, double radius);

}  // namespace sinew
