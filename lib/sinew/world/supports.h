// SPDX-License-Identifier: GPL-3.0-or-later
// The grips of a testing machine: each holds a part of the body along some of the scene's axes and
// moves it as prescribed; along the others the part is free. A clamp holds x, y and z, a roller one
// of them, an oblique roller any one direction.
//
//     world.supports = {roller, grip};
//     hold(world, body.rest.size());
//     const PinPose at = place_of(world.pins[k], rest, world.supports, now.supports);
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include <sinew/world/obstacle.h>
#include <sinew/world/pins.h>

namespace sinew {

struct World;

struct Support {
  std::string name;
  std::vector<std::uint32_t> particles;            ///< particles that it holds, by id, ascending
  std::array<bool, 3> holds = {true, true, true};  ///< their displacement along x, y, z
  /// Motion of its frame, which rests at `pivot` along the scene's axes; none: it does not move.
  ObstacleMotion motion = {};
  Vec3 pivot = Vec3::Zero();  ///< at rest, m; rotations and moments are about it
  Vec3 along = Vec3::Zero();  ///< instead of x, y, z: a direction, of length 1; 0: none
};

/// Adds what the world's supports hold to its pins. A component that two supports hold belongs to
/// the first. Throws bad input, which names them, for a support without particles, for two that
/// hold the same component of a particle where one of them moves, for one that holds a pinned
/// particle, and where an oblique roller and another support hold a particle.
void hold(World& world, std::size_t particles);

/// Where each support is; one that does not move is at its pivot.
std::vector<ObstaclePose> poses_of(std::span<const Support> supports, double time,
                                   const Pose& pose);

/// Where supports put a particle that was at `rest` (m), and its velocity there; only the
/// components that they hold have a meaning.
PinPose place_of(const Pinned& held, const Vec3& rest, std::span<const Support> supports,
                 std::span<const ObstaclePose> now);

/// Adds the `answer` (N) of the supports to all other forces on a particle at `at`: their force on
/// the body, its moment about their pivots, and its power into the body. The inertia of the
/// particle is not part of it.
void add_answer(const Pinned& held, const PinPose& at, const Vec3& answer,
                std::span<const ObstaclePose> now, std::span<Reaction> support_reactions);

/// The same components of `all`, 0 where `held` does not hold them.
Vec3 held_part(const Pinned& held, const Vec3& all);

}  // namespace sinew
