// SPDX-License-Identifier: GPL-3.0-or-later
// The springs between a few particles of a run and their bones, as in figure 3 of Komiya and Tokoi:
// reference point, radial force, twist force. Positions come from a frame; binding, springs and
// pose from the run's scene and body.
//
//     const DrawnPulls pulls(run);
//     for (const DrawnPull& pull : pulls.at(read_frame(run, 10))) draw(pull.reference,
//     pull.radial);
#pragma once

#include <vector>

#include <sinew/body/bone_force.h>
#include <sinew/core/vector.h>
#include <sinew/rig/motion.h>
#include <sinew/run/run_files.h>

namespace sinew {

/// How the heaviest bone of a particle pulls it, its weight included.
struct DrawnPull {
  std::size_t particle = 0;  ///< in the written order
  int bone = no_bone;
  Vec3 reference = Vec3::Zero(), position = Vec3::Zero();  ///< places of bone and particle, m
  Vec3 radial = Vec3::Zero();                              ///< N; of an anchor its whole spring
  Vec3 twist = Vec3::Zero(), axial = Vec3::Zero();         ///< N

  double strongest() const;  ///< strongest of the three, N
};

class DrawnPulls {
 public:
  /// Picks up to `count` written particles with bones, spread evenly over the body at rest. The run
  /// must outlive this object. Throws bad input where no particle has a bone, and for rigs that
  /// cannot be read.
  explicit DrawnPulls(const RunFiles& run, std::size_t count = 36);

  /// One for each picked particle, in the same order in all frames.
  std::vector<DrawnPull> at(const FrameState& frame) const;

  /// Force below which a pull is rounding, N.
  double negligible() const;

 private:
  struct Picked {
    std::size_t particle;  ///< in the written order
    Influence influence;
    Vec3 rest;  ///< m
  };

  const RunFiles* run_;
  Motion motion_;
  std::vector<BoneSprings> springs_;
  std::vector<Picked> picked_;
};

}  // namespace sinew
