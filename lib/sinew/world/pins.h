// SPDX-License-Identifier: GPL-3.0-or-later
// Particles that are held: where they rest, fixed to a bone, or along some axes by supports
// (supports.h). Which ones, and their positions. The stepper applies them.
//
//     const std::vector<Pinned> held = pinned(rest, pins, bones);
//     const PinPose at = pin_pose(held[k], rest[held[k].particle], skeleton, pose);
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sinew/body/forces.h>
#include <sinew/rig/pose.h>
#include <sinew/world/region.h>

namespace sinew {

struct Pin {
  Region region;       ///< at rest; its falloff is ignored
  int bone = no_bone;  ///< to which its particles are fixed; no_bone: the scene
};

inline constexpr std::int32_t no_support = -1;

/// A held particle, by its place in the written order.
struct Pinned {
  std::uint32_t particle = 0;
  int bone = no_bone;  ///< bone of a pin
  /// The support that holds its x, y and z; none at all: a pin holds it.
  std::array<std::int32_t, 3> support = {no_support, no_support, no_support};
  /// Direction along which an oblique roller, the first of these, holds, of length 1.
  Vec3 along = Vec3::Zero();

  bool is_oblique() const { return !along.isZero(0); }
  bool is_pin() const {
    return support[0] == no_support && support[1] == no_support && support[2] == no_support;
  }
  /// Whether it moves as prescribed along that axis; never of an oblique roller.
  bool holds(int axis) const {
    return !is_oblique() && (support[static_cast<std::size_t>(axis)] != no_support || is_pin());
  }
};

/// Where a held particle is, and its velocity.
struct PinPose {
  Vec3 position;  ///< m
  Vec3 velocity;  ///< m/s
};

/// The particles at `rest` (n x 3, m, by id) in a pin's shape or on its surface, ascending. A
/// particle in several pins is held by the first. Throws bad input for a bad region, an unknown
/// bone (`bones` is their count) or a pin without particles.
std::vector<Pinned> pinned(const Points& rest, const std::vector<Pin>& pins, int bones);

/// Where `pin` holds its particle, which was at `rest` (m), with the bones at `pose`.
PinPose pin_pose(const Pinned& pin, const Vec3& rest, const Skeleton& skeleton, const Pose& pose);

/// Adds the reaction of a pin's particle at `at` to its bone, if it is on one: the pin answers the
/// force `unheld` (N) of all else. The inertia of the particle is not part of it.
void add_reaction(const Pinned& pin, const PinPose& at, const Vec3& unheld, const Pose& pose,
                  std::vector<Reaction>& of_bones);

}  // namespace sinew
