// SPDX-License-Identifier: GPL-3.0-or-later
// The structure of a skeleton at rest. How it moves is motion.h, where it is now is pose.h.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sinew/core/options.h>
#include <sinew/core/vector.h>

namespace sinew {

inline constexpr int no_bone = -1;

/// How far a bone may turn on its parent, rad; see joint_limits.h.
struct JointLimits {
  double swing = pi;
  double least_twist = -std::numeric_limits<double>::infinity();
  double most_twist = std::numeric_limits<double>::infinity();

  bool any() const { return swing < pi || std::isfinite(least_twist) || std::isfinite(most_twist); }
};

/// Of one bone's springs, as factors on the binding's.
struct BoneStrength {
  double radial = 1, twist = 1, axial = 1;
};

struct Bone {
  std::string name;
  int parent = no_bone;  ///< index of an earlier bone; no_bone for a root
  double length = 0;     ///< m, > 0
  RigidFrame rest;       ///< origin: the head; columns: axis towards the tail, and two sides
  JointLimits limits = {};
  BoneStrength strength = {};

  Vec3 head() const { return rest.origin; }
  Vec3 axis() const { return rest.rotation.col(0); }
  Vec3 tail() const { return head() + length * axis(); }
};

/// Invariant: parents come first.
struct Skeleton {
  std::vector<Bone> bones;

  std::size_t size() const { return bones.size(); }
};

/// Builds the skeleton of these bones. Throws bad_value, with a key such as "bones[1].tail", for no
/// bones, a name used twice, an unknown or later parent, a root without head, a bone without length
/// or with two, connected to nothing, or with limits that allow nothing.
Skeleton make_skeleton(std::span<const BoneDefinition> bones);

/// The rig in a scene's directions and lengths: turned about the origin, then times `scale`. The
/// sides of its bones are those of a rig that has always stood so: all formats give the same.
Skeleton placed(Skeleton skeleton, double scale, const Mat3& turn);

/// A right-handed frame whose first column is `axis` (need not be unit, must not be zero). Its
/// second is across the axis and that one of x, y, z which is least along it, the first of those
/// that are equal to 1e-6: rounding swaps no sides.
Mat3 frame_along(const Vec3& axis);

// A skeleton from joints: files for animation (BVH, glTF) know places that turn, and no lengths.
//
// One bone per joint. Its head is the joint's place; its tail is, in this order:
//   the end the file states (a BVH's End Site),
//   the place of its only child, or the mean of its children's places,
//   the farthest of its children, where the mean lies in the joint itself,
//   a tenth of its parent's length along its parent (a tenth of the skeleton's size up, for a
//   root).
// A tail nearer than 1e-6 of the skeleton's size (the diagonal of its box) is none.

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
