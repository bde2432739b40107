// SPDX-License-Identifier: GPL-3.0-or-later
// Particles that are held: where they rest, or fixed to a bone. This says which and where; the
// stepper holds them.
#pragma once

#include <cstdint>
#include <vector>

#include <sinew/physics/world/region.h>
#include <sinew/rig/pose.h>

namespace sinew {

struct Pin {
  Region region;       ///< at rest; its falloff is not looked at
  int bone = no_bone;  ///< that carries its particles; no_bone: they stay
};

/// A held particle, by its place in the written order.
struct Pinned {
  std::uint32_t particle = 0;
  int bone = no_bone;
};

/// Where a held particle is, and its velocity.
struct PinPose {
  Vec3 position;  ///< m
  Vec3 velocity;  ///< m/s
};

/// The particles at `rest` (n x 3, m, by id) that lie in a pin's shape or on its surface,
/// ascending. The first pin that has a particle holds it. Throws bad input for a bad region, an
/// unknown bone
/// (`bones` is their count) or a pin that holds nothing.
std::vector<Pinned> pinned(const Points& rest, const std::vector<Pin>& pins, int bones);

/// Where `pin` holds its particle, which was at `rest` (m), as the bones are at `pose`.
PinPose pin_pose(const Pinned& pin, const Vec3& rest, const Skeleton& skeleton, const Pose& pose);

}  // namespace sinew
