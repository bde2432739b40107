// SPDX-License-Identifier: GPL-3.0-or-later
// The structure of a skeleton at rest. How it moves is motion.h, where it is now is pose.h.
#pragma once

#include <string>
#include <vector>

#include "core/rigid.h"
#include "core/settings.h"
#include "core/vector.h"

namespace sinew {

inline constexpr int no_bone = -1;

struct Bone {
  std::string name;
  int parent = no_bone;  ///< index of an earlier bone; no_bone for a root
  double length = 0;     ///< m, > 0
  RigidFrame rest;       ///< origin: the head; columns: axis towards the tail, and two sides

  Vec3 head() const { return rest.origin; }
  Vec3 axis() const { return rest.rotation.col(0); }
  Vec3 tail() const { return head() + length * axis(); }
};

/// Invariant: parents come first.
struct Skeleton {
  std::vector<Bone> bones;

  std::size_t size() const { return bones.size(); }
};

/// Builds the skeleton a scene describes. Throws bad input, naming the scene's line, for no
/// bones, a name used twice, an unknown or later parent, a root without head, or a bone without
/// length.
Skeleton make_skeleton(const Settings& settings);

/// A right-handed frame whose first column is `axis` (need not be unit, must not be zero).
Mat3 frame_along(const Vec3& axis);

}  // namespace sinew
