// SPDX-License-Identifier: GPL-3.0-or-later
// Skinning as animation systems do it, without physics: the baseline for an elastic body.
//
//     const BoneWeights weights = carried_weights(mesh_vertices, mesh_weights, rest);
//     const Points moved = linear_blend_skinned(rest, weights, skeleton, pose);
//
// Linear-blend: each vertex is the mean of its positions on its bones (Magnenat-Thalmann et al.
// 1988); bent joints lose volume. Dual-quaternion: the mean of the rigid motions themselves (Kavan
// et al. 2007); volume is kept, joints bulge.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/core/vector.h>
#include <sinew/rig/binding.h>
#include <sinew/rig/motion.h>
#include <sinew/rig/pose.h>

namespace sinew {

/// A rig as its file has it, in its own directions and units.
struct SkinnedRig {
  Rig rig;
  PolygonSoup mesh;     ///< the meshes that it moves, in the bind pose; empty for a rig alone
  BoneWeights weights;  ///< weights of mesh.points
};

/// The weights with which a binding skins each particle.
BoneWeights weights_of(const Binding& binding);

/// The weights of `vertices` (n x 3, m) at other points (m): the mean over the eight nearest
/// vertices that have weights, weighted by inverse distance; the four heaviest bones remain. A
/// point has none where no vertex has any. In parallel.
BoneWeights carried_weights(const Points& vertices, const BoneWeights& weights,
                            const Points& points);

/// Where vertices (n x 3, m, at rest) are at `pose`. Those without weights stay. In parallel.
Points linear_blend_skinned(const Points& rest, const BoneWeights& weights,
                            const Skeleton& skeleton, const Pose& pose);

/// The same with dual quaternions. Of the two rotations between a vertex's bones the shorter one
/// from its heaviest bone is used. Stretch is blended linearly, before the motion.
Points dual_quaternion_skinned(const Points& rest, const BoneWeights& weights,
                               const Skeleton& skeleton, const Pose& pose);

}  // namespace sinew
