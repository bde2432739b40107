// SPDX-License-Identifier: GPL-3.0-or-later
// Converts what moves beside the particles (particle_frame.h) to the datasets of one frame of each
// series. Points keep their number and order from frame to frame.
//
//     Dataset bones = bones_dataset(skeleton, pose, {.time = 1.5, .cycle = 3000});
#pragma once

#include <cstdint>
#include <span>

#include <sinew/core/dataset.h>
#include <sinew/core/triangles.h>
#include <sinew/rig/pose.h>

namespace sinew {

struct Moment {
  double time = 0;         ///< s
  std::int32_t cycle = 0;  ///< steps taken so far
};

/// `rest`: points of the input surface (n x 3, m); `bone`: the one that moves each point most.
Dataset surface_dataset(const Triangles& surface, const Points& rest,
                        std::span<const std::int32_t> bone, Moment moment);

/// An obstacle at one moment.
struct ObstacleFrame {
  const Triangles& surface;              ///< in the obstacle's own frame, m
  RigidFrame frame;                      ///< in the scene
  Vec3 velocity, angular_velocity;       ///< velocities of the frame, m/s and rad/s
  Vec3 reaction_force, reaction_moment;  ///< reaction of the body, N and N m about its origin
};

/// The surfaces of all obstacles in one dataset.
Dataset obstacles_dataset(std::span<const ObstacleFrame> obstacles, Moment moment);

/// A support or a load at one moment.
struct SupportFrame {
  bool load;                 ///< else a support
  Vec3 place, displacement;  ///< means of its part, m
  Vec3 force, moment;        ///< on the body, N and N m
  double power;              ///< into it, W
};

/// A vertex for each.
Dataset supports_dataset(std::span<const SupportFrame> supports, Moment moment);

/// Four lines per bone: head to tail, and its x, y, z axes, a quarter of the bone long.
Dataset bones_dataset(const Skeleton& skeleton, const Pose& pose, Moment moment);

/// Reaction of the body on each bone: force (N) and moment about the bone's head (N m); n x 3 each.
struct Reactions {
  std::span<const Vec3> force;
  std::span<const Vec3> moment;
};

Dataset frames_dataset(const Skeleton& skeleton, const Pose& pose, const Reactions& reactions,
                       Moment moment);

}  // namespace sinew
