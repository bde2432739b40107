// SPDX-License-Identifier: GPL-3.0-or-later
// What a joint allows: how far a bone may lean from its direction at rest on its parent (swing) and
// turn about itself (twist). A rotation is a twist about the bone's axis at rest, then a swing, the
// shortest rotation of that axis to where it points. What is asked beyond is held at the limit.
#pragma once

#include <string>
#include <vector>

#include <sinew/rig/motion.h>

namespace sinew {

/// By how much a motion asks more than a joint allows, rad.
struct Excess {
  double swing = 0, twist = 0;

  bool any() const { return swing > 0 || twist > 0; }
};

/// Holds `motion` of `bone` within its limits, with rates that are those of the held motion.
Excess limit(const Bone& bone, LocalMotion& motion);

struct LimitPassed {
  int bone = no_bone;
  double time = 0;  ///< when first, s of the scene
  Excess most;      ///< of swing and of twist each by itself
};

/// The bones that the clip would carry beyond their limits, by samples at its keys and between.
std::vector<LimitPassed> limits_passed(const Skeleton& skeleton, const Motion& motion);

// What in a motion would tear a body, or is not done as asked.

/// One line each, with numbers and a cure: bones that do not begin at rest without a preroll, that
/// jump from key to key or where a loop closes, and that are held at their limits. Shifts below
/// `least_shift` (m) and turns below a degree are not worth a word.
std::vector<std::string> motion_warnings(const Skeleton& skeleton, const Motion& motion,
                                         double least_shift);

}  // namespace sinew
