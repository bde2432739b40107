// SPDX-License-Identifier: GPL-3.0-or-later
// Soft particles that push each other away until they are evenly apart: how packings without a
// lattice come about. The energy of a pair is (1 - d / D)^2 D / 2 below the distance D, its minimum
// is approached by FIRE (Bitzek et al. 2006).
//
//     Points points = ...;
//     relax(points, {.distance = 2 * radius, .fixed = fixed});
#pragma once

#include <functional>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

struct RelaxOptions {
  double distance = 0;             ///< D, below which they push, m
  const std::vector<char>& fixed;  ///< one per particle: whether it stays where it is
  /// A further force on a particle at a place, over that of a pair at d = 0; none: nothing.
  std::function<Vec3(std::size_t particle, const Vec3& place)> field = {};
  int max_steps = 150;
  double enough = 1e-3;  ///< stops once nobody feels more than this, over the force at d = 0
};

/// Moves the points (m). The same for any number of threads.
void relax(Points& points, const RelaxOptions& options);

}  // namespace sinew
