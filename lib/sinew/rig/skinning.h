// SPDX-License-Identifier: GPL-3.0-or-later
// Skinning as animation systems do it, without any physics: what an elastic body is compared with.
//
// Linear-blend: each vertex is the mean of where its bones carry it (Magnenat-Thalmann et al.
// 1988); joints that turn lose volume. Dual-quaternion: the mean of the rigid motions themselves
// (Kavan et al. 2007); volume stays, joints bulge.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/rig/pose.h>

namespace sinew {

// How much each bone moves each point: what files say of vertices, carried to other points.

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

/// Where vertices (n x 3, m, at rest) are at `pose`. Those without weights stay. In parallel.
Points linear_blend_skinned(const Points& rest, const BoneWeights& weights,
                            const Skeleton& skeleton, const Pose& pose);

/// The same by dual quaternions. Of two ways to turn a vertex's bones into each other the shorter
/// one from its heaviest bone is taken. Stretch is blended linearly, before the motion.
Points dual_quaternion_skinned(const Points& rest, const BoneWeights& weights,
                               const Skeleton& skeleton, const Pose& pose);

}  // namespace sinew
