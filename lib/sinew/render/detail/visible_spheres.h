// SPDX-License-Identifier: GPL-3.0-or-later
// Which of many equal spheres may be seen: those deep within a body cost time where graphics are
// computed, and change nothing.
//
//     for (const std::size_t i : visible_spheres(snapshot.particles, snapshot.radius, view))
//       add(i);
#pragma once

#include <cstddef>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

/// All that a parallel projection along the third row of `view` shows, and some that it does not:
/// those that others in front do not hide entirely, by cells of a sixth of the radius; ascending.
std::vector<std::size_t> visible_spheres(const Points& centers, double radius, const Mat3& view);

}  // namespace sinew
