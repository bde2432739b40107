// SPDX-License-Identifier: GPL-3.0-or-later
// Converts the particles of one moment to the dataset of a frame. Its rows are in the written
// order, by id, whatever the order of the particles; most of its columns are computed from the
// frame while they are written.
//
//     const Dataset data = particles_dataset(frame, positions_by_id(particles), {.time = 1.5});
//     series.add(data);
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <sinew/core/dataset.h>
#include <sinew/core/energies.h>
#include <sinew/core/particles.h>
#include <sinew/io/frames.h>
#include <sinew/rig/binding.h>

namespace sinew {

/// The particles at one moment beside their positions. Forces and counts are in the order of `now`.
struct ParticleFrame {
  const Particles& now;                     ///< in any order; their positions are not used
  const Points& rest;                       ///< m, by id
  const Binding& binding;                   ///< index: particle id
  std::span<const Vec3> force_pair;         ///< N
  std::span<const Vec3> force_damping;      ///< N
  std::span<const Vec3> force_bone;         ///< N
  std::span<const std::int32_t> neighbors;  ///< number closer than b
  Energies energies;
  std::span<const Vec3> force_world = {};           ///< N; empty without a world
  std::span<const std::int32_t> material = {};      ///< index: id; empty where there is only one
  std::span<const std::int32_t> broken_bonds = {};  ///< number at each; empty: no bonds
  /// What is written as their ids, for a part of a body, whose own begin with 0; empty: these.
  std::span<const std::int32_t> ids = {};
  std::span<const std::int32_t> group = {}, level = {};  ///< index: id; empty: none
  std::span<const Vec3> force_group = {};                ///< N; empty without groups
  std::span<const std::int32_t> limited = {};            ///< times of each; empty: never
  Unbalanced unbalanced = {};
};

/// What a frame contains.
struct ParticleSelection {
  std::vector<std::int32_t> ids;         ///< ids of the particles, ascending; empty: all
  std::vector<std::string_view> arrays;  ///< beside the points; empty: all
};

/// `positions`: of the frame's particles, by id. The array "force" is the sum of all forces. What
/// the frame refers to and the ids of the selection must outlive the dataset.
Dataset particles_dataset(const ParticleFrame& frame, Points positions, Moment moment,
                          const ParticleSelection& selection = {});

}  // namespace sinew
