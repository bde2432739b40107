// SPDX-License-Identifier: GPL-3.0-or-later
// Converts the state of a simulation to the datasets of one frame of each series. Points keep their
// number and order from frame to frame: particles are in the written order, by id.
//
//     Dataset particles = particles_dataset(frame, {.time = 1.5, .cycle = 3000});
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

/// The particles at one moment. All spans have one element per particle.
struct ParticleFrame {
  const Particles& now;                     ///< in any order
  const Points& rest;                       ///< m, in the written order
  std::span<const std::int32_t> bone;       ///< in the written order
  std::span<const Vec3> force_pair;         ///< N; these in the order of `now`
  std::span<const Vec3> force_damping;      ///< N
  std::span<const Vec3> force_bone;         ///< N
  std::span<const std::int32_t> neighbors;  ///< number closer than b
  Energies energies;
  std::span<const double> weight;          ///< of the bone in each particle, in the written order
  std::span<const Vec3> force_world = {};  ///< N, in the order of `now`; empty without a world
  std::span<const std::int32_t> broken_bonds = {};  ///< of each; empty where there are no bonds
};

/// In parallel. The array "force" is the sum of all forces.
Dataset particles_dataset(const ParticleFrame& frame, Moment moment);

/// `rest`: points of the input surface (n x 3, m); `bone`: the one that moves each point most.
Dataset surface_dataset(const Triangles& surface, const Points& rest,
                        std::span<const std::int32_t> bone, Moment moment);

/// An obstacle at one moment.
struct ObstacleFrame {
  const Triangles& surface;              ///< in the obstacle's own frame, m
  RigidFrame frame;                      ///< in the scene
  Vec3 velocity, angular_velocity;       ///< of the frame, m/s and rad/s
  Vec3 reaction_force, reaction_moment;  ///< of the body on it, N and N m about the frame's origin
};

/// The surfaces of all obstacles in one dataset.
Dataset obstacles_dataset(std::span<const ObstacleFrame> obstacles, Moment moment);

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
