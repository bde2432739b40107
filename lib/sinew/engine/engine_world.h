// SPDX-License-Identifier: GPL-3.0-or-later
// What surrounds a body, for an engine in another program: obstacles, a medium, fields, pins,
// supports and loads. Obstacles and supports move as functions say, which no file can hold: where
// they are at each step is written instead.
//
//     setup.world = engine_world(*body.world);
//     write_engine_poses(file, *body.world, skeleton, motion, plan, first, last);
//     ...
//     EngineWorld world(file, *setup.world, first);
//     world.go_to(step, time);
//     const ParticleWorld on = world_on(particle, mass, *setup.world, world.now(), ...);
#pragma once

#include <cstdint>
#include <filesystem>

#include <sinew/body/step_plan.h>
#include <sinew/rig/motion.h>
#include <sinew/world/world.h>

namespace sinew {

/// All of it but the motions.
World engine_world(const World& world);

/// Writes the poses of all obstacles, then of all supports, before steps `first` to `last`. Throws
/// not written.
void write_engine_poses(const std::filesystem::path& file, const World& world,
                        const Skeleton& skeleton, const Motion& motion, const StepPlan& plan,
                        std::int64_t first, std::int64_t last);

class EngineWorld {
 public:
  /// The file begins with step `first`. World and file must stay.
  EngineWorld(std::filesystem::path file, const World& world, std::int64_t first);

  /// Before a step, at `time` (s). Throws bad input where the file lacks it.
  void go_to(std::int64_t step, double time);
  const WorldNow& now() const { return now_; }

  /// How the particle of this id is held; nullptr: not at all.
  const Pinned* held(std::int32_t id) const;
  /// The sum of all loads on it, N.
  Vec3 load(std::int32_t id) const;

 private:
  std::size_t width() const;
  void read_from(std::int64_t step);

  std::filesystem::path file_;
  const World& world_;
  std::int64_t first_, read_ = 0;  ///< step of the file's beginning, and of poses_
  std::vector<double> poses_;      ///< poses of some steps
  WorldNow now_;
};

}  // namespace sinew
