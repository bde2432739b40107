// SPDX-License-Identifier: GPL-3.0-or-later
// How much each bone moves each point: what files say of vertices, carried to other points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vector.h"

namespace sinew {

struct BoneWeight {
  int bone = -1;
  double weight = 0;  ///< > 0
};

/// Of n points.
struct BoneWeights {
  std::vector<std::uint32_t> first;  ///< n + 1 long; point i has [first[i], first[i + 1])
  std::vector<BoneWeight> weights;   ///< of each point the heaviest first, each bone once, sum 1

  std::size_t size() const { return first.empty() ? 0 : first.size() - 1; }
  std::span<const BoneWeight> of(std::size_t i) const {
    return {weights.data() + first[i], first[i + 1] - first[i]};
  }
};

/// The weights of `vertices` (n x 3, m) at other points (m): the mean over the eight nearest
/// vertices that have weights, each by the inverse of its distance; the four heaviest bones remain.
/// A point has none where no vertex has any. In parallel.
BoneWeights carried_weights(const Points& vertices, const BoneWeights& weights,
                            const Points& points);

}  // namespace sinew
