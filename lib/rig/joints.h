// SPDX-License-Identifier: GPL-3.0-or-later
// A skeleton from joints: files for animation (BVH, glTF) know places that turn, and no lengths.
//
// One bone per joint. Its head is the joint's place; its tail is, in this order:
//   the end the file states (a BVH's End Site),
//   the place of its only child, or the mean of its children's places,
//   the farthest of its children, where the mean lies in the joint itself,
//   a tenth of its parent's length along its parent (a tenth of the skeleton's size up, for a
//   root).
// A tail nearer than 1e-6 of the skeleton's size (the diagonal of its box) is none.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rig/skeleton.h"

namespace sinew {

struct Joint {
  std::string name;
  int parent = no_bone;     ///< index of an earlier joint; no_bone for a root
  Vec3 place;               ///< at rest, m, in the scene's directions
  std::optional<Vec3> end;  ///< where the bone ends, if the file says so; as place
};

/// Bone i is joint i. A name that is taken gets a suffix, "_2", "_3"; an empty one becomes
/// "joint_INDEX". Throws bad input for no joints, a parent that does not come first, places that
/// are not finite, or joints that all lie in one point.
Skeleton skeleton_of(const std::vector<Joint>& joints);

}  // namespace sinew
