// SPDX-License-Identifier: GPL-3.0-or-later
// The limits of joints: how far a bone may lean from its direction at rest on its parent (swing)
// and rotate about itself (twist). A rotation is a twist about the bone's axis at rest, then a
// swing, the shortest rotation of that axis to its direction. Motion beyond a limit is clamped
// to the limit.
//
//     const Excess excess = limit(bone, motion);
//     for (const std::string& line : motion_warnings(skeleton, motion, min_shift)) print(line);
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sinew/rig/motion.h>

namespace sinew {

/// Angles by which a motion exceeds the limits of a joint, rad.
struct Excess {
  double swing = 0, twist = 0;

  bool any() const { return swing > 0 || twist > 0; }
};

/// Restricts `motion` of `bone` to its limits, with the rates of the restricted motion.
Excess limit(const Bone& bone, LocalMotion& motion);

/// The first key of a clip, s; 0 where no curve has several. All before it is one pose.
double first_key(const Motion& motion);

/// The bones that a clip turns by over a degree from key to key, or moves by over a thousandth of
/// the skeleton's size. Those of poses move none.
struct MovingBones {
  std::vector<int> turned, all;  ///< ascending
};
MovingBones moving_bones(const Skeleton& skeleton, const Motion& motion);

/// The largest scale in the file of a clip, of the `bones` that count; none where they keep their
/// sizes.
std::optional<IgnoredScale> largest_scale(const Motion& motion, const std::vector<bool>& bones);

struct LimitPassed {
  int bone = no_bone;
  double time = 0;  ///< time of the first excess, s of the scene
  Excess most;      ///< excess of swing and of twist separately
};

/// The bones that the clip would move beyond their limits, sampled at its keys and between them.
std::vector<LimitPassed> limits_passed(const Skeleton& skeleton, const Motion& motion);

/// How long the way from rest to the clip's first pose should take, s, in tenths: 1 per 90 degrees
/// that a bone turns on its parent, and per half of the skeleton's size that one moves. 0 where the
/// clip begins at rest.
double preroll_for(const Skeleton& skeleton, const Motion& motion);

// What in a motion would tear a body, or is not done as requested.

/// One line each, with numbers and a cure: bones that do not begin at rest without a preroll, that
/// jump from key to key or where a loop closes, and that are clamped to their limits. Shifts below
/// `min_shift` (m) and rotations below a degree are not reported. `posed`: the body begins where
/// the motion does.
std::vector<std::string> motion_warnings(const Skeleton& skeleton, const Motion& motion,
                                         double min_shift, bool posed = false);

/// A line about the largest scale that the bones do not follow; "": there is none.
std::string scale_warning(const Skeleton& skeleton, const Motion& motion,
                          const std::vector<bool>& bones);

}  // namespace sinew
