// SPDX-License-Identifier: GPL-3.0-or-later
// One skin around parts of a body that overlap: limbs, and what joins them.
//
//     const Triangles skin = skin_around(capsules, 0.02);
#pragma once

#include <vector>

#include <sinew/core/triangles.h>

namespace sinew {

/// The points within `radius` of a line, all in m.
struct Capsule {
  Vec3 from, to;
  double radius = 0;  ///< > 0
};

/// The surface of the union, closed and outward, with sides up to about `side` (m, > 0) and errors
/// of a twelfth of that: gaps and limbs wider than these stay. The same for any number of threads.
/// Parts too thin for it are wrapped with the rest instead (wrap() in repair.h, whose errors it
/// throws).
Triangles skin_around(const std::vector<Capsule>& capsules, double side);

}  // namespace sinew
