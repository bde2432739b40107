// SPDX-License-Identifier: GPL-3.0-or-later
// Skinning as animation systems do it, without any physics: what an elastic body is compared with.
//
// Linear-blend: each vertex is the mean of where its bones carry it (Magnenat-Thalmann et al.
// 1988); joints that turn lose volume. Dual-quaternion: the mean of the rigid motions themselves
// (Kavan et al. 2007); volume stays, joints bulge.
#pragma once

#include "rig/bone_weights.h"
#include "rig/pose.h"

namespace sinew {

/// Where vertices (n x 3, m, at rest) are at `pose`. Those without weights stay. In parallel.
Points linear_blend_skinned(const Points& rest, const BoneWeights& weights,
                            const Skeleton& skeleton, const Pose& pose);

/// The same by dual quaternions. Of two ways to turn a vertex's bones into each other the shorter
/// one from its heaviest bone is taken. Stretch is blended linearly, before the motion.
Points dual_quaternion_skinned(const Points& rest, const BoneWeights& weights,
                               const Skeleton& skeleton, const Pose& pose);

}  // namespace sinew
