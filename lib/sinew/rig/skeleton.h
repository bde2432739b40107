// SPDX-License-Identifier: GPL-3.0-or-later
// The structure of a skeleton at rest. motion.h moves it; pose.h is its state at one moment.
//
//     const Skeleton skeleton = make_skeleton(definitions);
//     const Vec3 tail = skeleton.bones[0].tail();
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sinew/core/options.h>
#include <sinew/core/vector.h>

namespace sinew {

inline constexpr int no_bone = -1;

/// How far a bone may rotate on its parent, rad; see motion_checks.h.
struct JointLimits {
  double swing = pi;
  double min_twist = -std::numeric_limits<double>::infinity();
  double max_twist = std::numeric_limits<double>::infinity();

  bool any() const { return swing < pi || std::isfinite(min_twist) || std::isfinite(max_twist); }
};

/// Spring constants of one bone, as factors of the binding's.
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

/// The box around all bones, m.
Box bounds(const Skeleton& skeleton);

/// The bone of a name that `key` gives. Throws bad_value where there is none.
int bone_named(const Skeleton& skeleton, const std::string& name, const std::string& key);

/// Builds the skeleton of these bones. Throws bad_value, with a key such as "bones[1].tail", for no
/// bones, a name used twice, an unknown or later parent, a root without head, a bone without length
/// or with two, connected to nothing, or with limits that exclude every rotation.
Skeleton make_skeleton(std::span<const BoneDefinition> bones);

/// The rig in a scene's place, directions and lengths. The sides of its bones are those of a rig
/// built in these directions: all formats give the same.
Skeleton placed(Skeleton skeleton, const Placement& placement);

/// A right-handed frame whose first column is along `axis` (any length but 0). Its second is across
/// the axis and that one of x, y, z which is least along it, the first of those that are equal to
/// 1e-6: rounding does not change the sides.
Mat3 frame_along(const Vec3& axis);

// A skeleton from joints: animation files (BVH, glTF) have rotating joints, and no bone lengths.
//
// One bone per joint. Its head is the joint's place; its tail is the first of these that exists:
//   the end that the file gives (End Site of BVH),
//   the place of its only child, or the mean of its children's places,
//   the farthest of its children, where the mean is in the joint itself,
//   a tenth of its parent's length along its parent (a tenth of the skeleton's size up, for a
//   root).
// A tail nearer than 1e-6 of the skeleton's size (the diagonal of its box) does not count.

struct Joint {
  std::string name;
  int parent = no_bone;     ///< index of an earlier joint; no_bone for a root
  Vec3 place;               ///< at rest, m, in the scene's directions
  std::optional<Vec3> end;  ///< where the bone ends, if the file gives it; like place
};

/// Bone i is joint i. `cure`: what the file's user can do where all joints are in one point. A name
/// already used gets a suffix, "_2", "_3"; an empty one becomes "joint_INDEX". Throws bad input for
/// no joints, a parent that does not come first, places that are not finite, or joints that are all
/// in one point.
Skeleton skeleton_of(const std::vector<Joint>& joints,
                     const char* cure = "give them different places");

// How much each bone moves each point: weights of a file's vertices, interpolated to other points.

struct BoneWeight {
  int bone = -1;
  double weight = 0;  ///< > 0
};

/// Weights of n points.
struct BoneWeights {
  std::vector<std::uint32_t> first;  ///< n + 1 long; point i has [first[i], first[i + 1])
  /// Weights of each point, the heaviest first, each bone once, sum 1.
  std::vector<BoneWeight> weights;

  std::size_t size() const { return first.empty() ? 0 : first.size() - 1; }
  std::span<const BoneWeight> of(std::size_t i) const {
    return {weights.data() + first[i], first[i + 1] - first[i]};
  }
};

}  // namespace sinew
