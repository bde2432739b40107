// SPDX-License-Identifier: GPL-3.0-or-later
// A small bar on moving bones, stepped by LAMMPS under mpirun and by the built-in engine.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>

#include <sinew/core/file.h>
#include <sinew/engine/engine_files.h>
#include <sinew/world/world.h>
#include "support/temp_folder.h"
#include "support/world.h"

namespace sinew::test {

inline constexpr double bar_radius = 0.01;

/// A ball that moves, on a bone, and sticks; a plane without stick.
inline void add_obstacles(World& world) {
  Obstacle ball{"ball", SphereShape{Vec3::Zero(), 0.05}, {}, 20, 0.03, 0.4, 0.02};
  ball.motion = [](double time, const Pose& pose) {
    ObstaclePose now;
    now.frame.origin = pose[0].frame.origin + Vec3(0.06 - 0.5 * time, 0.02, 0.1);
    now.velocity = Vec3(-0.5, 0, 0);
    now.angular_velocity = Vec3(0, 1, 3);
    return now;
  };
  world.obstacles = {ball, {"floor", PlaneShape{Vec3(0, 0, 0.01)}, {}, 30, 0.02, 0.7}};
}

inline void add_fields(World& world) {
  world.drag = {2.5, Vec3(0.3, 0, -0.1)};
  const Region part{CapsuleShape{Vec3::Zero(), Vec3(0, 0, 0.1), 0.02}, 0.03};
  world.fields = {{"wind", UniformAcceleration{Vec3(3, 1, 0)}, {}, {{0, 1}, {0.5, 2}}},
                  {"weight", ForceDensity{Vec3(0, 100, 0)}, part, {}},
                  {"pull", Attraction{Vec3(0.1, 0, 0), 4, 0.02}, {}, {}},
                  {"swirl", Swirl{Vec3::Zero(), Vec3(0, 1, 1), 2, 0.05}, {}, {}}};
}

/// The first particles in the scene, others on a bone, along one axis by a support, and a load.
inline void add_grips(World& world, std::size_t particles) {
  world.pins = {{0}, {1}, {2}, {20, 1}, {21, 1}};
  Support roller{"roller", {40, 41, 42}, {false, false, true}, {}, Vec3(0, 0, 0.02)};
  roller.motion = [](double time, const Pose&) {
    ObstaclePose now;
    now.frame.origin = Vec3(0, 0, 0.02 + 0.1 * time);
    now.velocity = Vec3(0, 0, 0.1);
    return now;
  };
  world.supports = {roller};
  Load load{"load", {{0, 0.1}, {0, 1}}, {50, 51, 60}, {0.2, 0.3, 0.5}, Vec3(0.05, 0, -0.02)};
  world.loads = {load};
  hold(world, particles);
}

/// A bar that bends and twists fast.
struct Bar {
  Settings settings = box_scene(21);
  Points rest = fcc_box(5, 5, 21, bar_radius);
  double shake = 0.02, speed = 0.05;  ///< in radii, and m/s
  std::shared_ptr<World> world;

  Bar() {
    KeyDefinition end = bend_key(0.1, 20);
    end.twist = 15;
    settings.tracks = {track("lower", {bend_key(-0.1, 0), bend_key(0.1, -5)}),
                       track("upper", {bend_key(-0.1, 0), end})};
    settings.solver.gravity = Vec3(1, -2, -9.81);
  }

  Body body() const {
    Body made = make_body(settings, rest);
    made.world = world;
    return made;
  }
  Motion motion() const { return motion_of(settings, body().skeleton); }
  Stepping stepping(double step) const { return stepping_of(settings.solver, step); }
  Particles particles() const { return shaken(rest, body().material, shake * bar_radius, speed); }
  World& surroundings() {
    if (!world) world = std::make_shared<World>();
    return *world;
  }
  double step(double factor) const {
    return factor * step_limit(settings.solver.integrator, body());
  }
  Simulation simulation(double step) const {
    return Simulation(body(), motion(), particles(), stepping(step));
  }
};

inline int run_lammps(const std::filesystem::path& folder, int ranks) {
  // Each mpirun keeps its sessions in a folder of its own: another one that ends would remove them.
  const std::string command = "OMPI_MCA_orte_tmpdir_base=" + folder.string() + " mpirun " +
                              (geteuid() == 0 ? "--allow-run-as-root " : "") +
                              "--oversubscribe --bind-to none -n " + std::to_string(ranks) + ' ' +
                              SINEW_LAMMPS + ' ' + folder.string() + " > " +
                              (folder / "said.txt").string() + " 2>&1";
  return std::system(command.c_str());
}

/// What LAMMPS makes of a simulation's present state.
class OnLammps {
 public:
  /// After `steps` steps in one frame; none: forces at the start.
  OnLammps(const Simulation& simulation, const Motion& motion, const Stepping& stepping,
           const StepPlan& plan, int steps, int ranks)
      : simulation_(simulation), ids_(simulation.particles().id), end_(simulation.steps() + steps) {
    const SimulationState state = simulation.save();
    write_engine_run({folder_.path()}, {simulation.body(), motion, stepping, plan,
                                        static_cast<int>(std::max<std::int64_t>(1, end_)),
                                        steps > 0, simulation.particles().mass, state, ids_, true});
    EXPECT_EQ(run_lammps(folder_.path(), ranks), 0)
        << read_file(folder_.path() / "said.txt") << read_file(folder_.path() / "log.lammps");
    ranks_ = ranks;
  }

  SimulationState state() const {
    return read_engine_state({folder_.path()}, end_, simulation_.save(), ids_);
  }
  EngineMoment moment() const { return read_engine_moment({folder_.path()}, end_); }

  Forces forces() const {
    Forces forces;
    const std::size_t n = ids_.size();
    for (Points* part : {&forces.pair, &forces.damping, &forces.bone, &forces.world})
      part->resize(n);
    forces.neighbors.assign(n, -1);
    for (int rank = 0; rank < ranks_; ++rank) {
      const auto rows = read_engine_piece(EngineFolder{folder_.path()}.piece("forces", end_, rank));
      for (std::size_t k = 0; k < rows.size(); k += forces_width) {
        const auto i = static_cast<std::size_t>(rows[k]);  // ids are places here
        forces.pair[i] = Vec3(rows[k + 1], rows[k + 2], rows[k + 3]);
        forces.damping[i] = Vec3(rows[k + 4], rows[k + 5], rows[k + 6]);
        forces.bone[i] = Vec3(rows[k + 7], rows[k + 8], rows[k + 9]);
        forces.world[i] = Vec3(rows[k + 10], rows[k + 11], rows[k + 12]);
        forces.neighbors[i] = static_cast<int>(rows[k + 13]);
      }
    }
    return forces;
  }

 private:
  TempFolder folder_;
  const Simulation& simulation_;
  std::vector<std::int32_t> ids_;
  std::int64_t end_;
  int ranks_ = 0;
};

}  // namespace sinew::test
