// SPDX-License-Identifier: GPL-3.0-or-later
// Bones along the limbs of a body, and a motion that bends each limb a little and back.
//
//     const LimbRig rig = bones_of(limbs, {.radius = radius});
//     const Skeleton skeleton = make_skeleton(rig.bones);
#pragma once

#include <vector>

#include <sinew/core/options.h>
#include <sinew/rig/limbs.h>

namespace sinew {

struct LimbRigOptions {
  double radius = 0;   ///< of the particles, m: bones end as far below the tips
  double angle = 30;   ///< by which a limb bends, in all, degrees
  double bend = 0.5;   ///< time to bend, s
  double hold = 0.25;  ///< time it stays bent, s; then it bends back
};

struct LimbRig {
  std::vector<BoneDefinition> bones;  ///< parents first; the root of each body has no parent
  std::vector<TrackDefinition> tracks;
};

/// One root per body, in its middle, does not move. A limb begins with a bone in the ball around
/// that place, which does not move on its parent either, and goes on with bones short enough for
/// its curves and for a smooth bend. All of its bones turn about one axis, across the limb, towards
/// the side to which the body is thin: limbs side by side do not meet. Those that hold other limbs
/// bend less, those whose both ends are held not at all; a ring that begins in the middle of the
/// body is folded.
LimbRig bones_of(const std::vector<Limb>& limbs, const LimbRigOptions& options);

}  // namespace sinew
