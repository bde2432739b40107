// SPDX-License-Identifier: GPL-3.0-or-later
// Points that follow the particles near them linearly, y = sum_j w_j x_j: weights of moving least
// squares, (1 - (s / h)^2)^3 (1 + (Y - M) . S^-1 (X_j - M)) with M and S the weighted mean and
// second moments of the particles near Y, which sum to 1 and give Y itself at rest. So a point
// follows every affine motion exactly, and a force on it becomes forces w_j f on particles with
// the same sum, moment and power.
//
//     const FollowingPoints points = following(places, rest, radius);
//     const Points now = points.at(positions);
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

struct FollowingPoints {
  std::vector<std::uint32_t> first;     ///< n + 1 long; point k has [first[k], first[k + 1])
  std::vector<std::uint32_t> particle;  ///< particles of the body, or wherever positions come from
  std::vector<double> weight;           ///< sums to 1 for each point; some may be negative
  Vec3 origin = Vec3::Zero();  ///< place near the body, m: far from it, weights lose what they sum

  std::size_t size() const { return first.empty() ? 0 : first.size() - 1; }
  /// Where they are while the particles are at `now`, m. In parallel.
  Points at(const Points& now) const;
};

/// Follows the particles nearest to each place (n x 3, m), of those at `rest` (m) with `radius`
/// (m). Where these lie in one plane or on one line, a place beside it follows its foot there.
/// Throws bad input for no particles. In parallel.
FollowingPoints following(const Points& places, const Points& rest, double radius,
                          std::size_t count = 20);

/// The particle nearest to each place; the lower of two. Throws bad input for none. Parallel.
std::vector<std::uint32_t> nearest_particles(const Points& places, const Points& rest,
                                             double radius);

}  // namespace sinew
