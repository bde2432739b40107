// SPDX-License-Identifier: GPL-3.0-or-later
// From the values of core and rig to what one frame of each series holds. Points keep their number
// and order from frame to frame: particles stand in the written order, by id.
#pragma once

#include <cstdint>
#include <span>

#include <sinew/core/dataset.h>
#include <sinew/core/particles.h>
#include <sinew/core/simulation_state.h>
#include <sinew/core/triangles.h>
#include <sinew/rig/pose.h>

namespace sinew {

struct Moment {
  double time = 0;         ///< s
  std::int32_t cycle = 0;  ///< steps taken so far
};

/// What is known of the particles at one moment. All spans are as long as there are particles.
struct ParticleFrame {
  const Particles& now;                     ///< in any order
  const Points& rest;                       ///< m, in the written order
  std::span<const std::int32_t> bone;       ///< in the written order
  std::span<const Vec3> force_pair;         ///< N; these in the order of `now`
  std::span<const Vec3> force_damping;      ///< N
  std::span<const Vec3> force_bone;         ///< N
  std::span<const std::int32_t> neighbors;  ///< partners within b
  Energies energies;
  std::span<const double> weight;          ///< of the bone in each particle, in the written order
  std::span<const Vec3> force_world = {};  ///< N, as the others; empty where there is no world
  std::span<const std::int32_t> broken_bonds = {};  ///< of each; empty where there are no bonds
};

/// In parallel. The force written is the sum of all.
Dataset particles_dataset(const ParticleFrame& frame, Moment moment);

/// `rest` are the points of the input surface (n x 3, m); `bone` the one that moves each most.
Dataset surface_dataset(const Triangles& surface, const Points& rest,
                        std::span<const std::int32_t> bone, Moment moment);

/// An obstacle at one moment.
struct ObstacleFrame {
  const Triangles& surface;              ///< about the obstacle's own frame, m
  RigidFrame frame;                      ///< where that is
  Vec3 velocity, angular_velocity;       ///< of the frame, m/s and rad/s
  Vec3 reaction_force, reaction_moment;  ///< of the body on it, N and N m about the frame's origin
};

/// The surfaces of all obstacles in one.
Dataset obstacles_dataset(std::span<const ObstacleFrame> obstacles, Moment moment);

/// Four lines per bone: head to tail, and its x, y, z axes, a quarter of the bone long.
Dataset bones_dataset(const Skeleton& skeleton, const Pose& pose, Moment moment);

/// What the body does to each bone: force (N) and moment about the bone's head (N m); n x 3 each.
struct Reactions {
  std::span<const Vec3> force;
  std::span<const Vec3> moment;
};

Dataset frames_dataset(const Skeleton& skeleton, const Pose& pose, const Reactions& reactions,
                       Moment moment);

}  // namespace sinew
