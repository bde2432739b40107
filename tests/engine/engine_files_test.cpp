// SPDX-License-Identifier: GPL-3.0-or-later
// What sinew and an engine in another program write for each other.
#include <gtest/gtest.h>
#include <unistd.h>
#include <filesystem>

#include <sinew/core/file.h>
#include <sinew/engine/detail/serialize.h>
#include <sinew/engine/engine_files.h>
#include <sinew/engine/engine_talk.h>
#include <sinew/engine/engine_world.h>
#include <sinew/world/features.h>
#include "support/temp_folder.h"
#include "support/world.h"

namespace sinew::engine_files_test {

constexpr double r = 0.01;

class EngineFiles : public testing::Test {
 protected:
  EngineFiles() {
    folder_.path = own_.path();
    settings_.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(1, 30)})};
    settings_.material.model = MaterialModel::bonded;
    simulation_.emplace(test::simulation_from(settings_, rest_, particles_, 1e-4));
  }
  const Simulation& simulation() const { return *simulation_; }
  const std::vector<std::int32_t>& ids() const { return simulation().particles().id; }

  void write() const {
    const Motion motion = motion_of(settings_, simulation().body().skeleton);
    const Stepping stepping = stepping_of(settings_.solver, 1e-4);
    const StepPlan plan(1e-4, 10, {1, 3, 1});
    const SimulationState state = simulation().save();
    write_engine_run(folder_, {simulation().body(), motion, stepping, plan, 10, 3,
                               simulation().particles().mass, state, ids()});
  }

  void write_state(std::size_t particles) const {
    std::vector<double> rows;
    for (std::size_t i = 0; i < particles; ++i)
      for (const double number : {double(i), 1.0 * i, 2.0, 3.0, 4.0, 5.0, 6.0})
        rows.push_back(number);
    write_engine_piece(folder_.piece("state", 7, 0), rows);
    EngineMoment moment;
    moment.steps = 7;
    moment.particles = {particles};
    write_engine_moment(folder_, moment);
  }

  TempFolder own_;
  EngineFolder folder_;
  Settings settings_ = test::box_scene(11);
  Points rest_ = test::fcc_box(5, 5, 11, r);
  Particles particles_ = test::particles_of(settings_, rest_);
  std::optional<Simulation> simulation_;
};

TEST_F(EngineFiles, TellTheMaterialOfARandomPacking) {
  settings_.body.packing = Packing::random;
  const Material material = test::make_body(settings_, rest_).material;
  EXPECT_LT(material.order, 1);
  simulation_.emplace(test::simulation_from(settings_, rest_, particles_, 1e-4));
  write();
  EXPECT_EQ(read_engine_setup(folder_).material.young_modulus(), material.young_modulus());
}

TEST_F(EngineFiles, TellWhatIsToBeStepped) {
  write();
  const EngineSetup setup = read_engine_setup(folder_);
  const Body& body = simulation().body();
  EXPECT_EQ(setup.particles, rest_.size());
  EXPECT_EQ(setup.plan().steps_until(3), 50);
  EXPECT_EQ(setup.material.bond.stiffness, body.material.bond.stiffness);
  const Pose there = pose_at(setup.skeleton, setup.motion, 0.4),
             here = pose_at(body.skeleton, motion_of(settings_, body.skeleton), 0.4);
  EXPECT_EQ(there[1].frame.rotation, here[1].frame.rotation);
  std::size_t next = 0;
  for_each_engine_particle(folder_, setup, [&](const EngineParticle& one) {
    const ParticleRow row(one.row, setup.shape);
    EXPECT_EQ(one.id, next++);
    EXPECT_EQ(one.position, rest_[one.id]);
    EXPECT_EQ(row.rest(), rest_[one.id]);
    EXPECT_EQ(row.influence(0).weight, body.binding.weight(one.id));
    for (int k = 0; k < row.bonds(); ++k) {
      const ParticleRow::Bond bond = row.bond(k);
      EXPECT_EQ(bond.spring.length, (rest_[one.id] - rest_[bond.partner]).norm());
      EXPECT_EQ(row.is_nearest(bond.partner), k < row.nearest());
    }
  });
  EXPECT_EQ(next, rest_.size());
}

TEST_F(EngineFiles, AreNotWrittenOfWhatEnginesDoNotKnow) {
  settings_.material.breaking_strain = 0.1;
  simulation_.emplace(test::simulation_from(settings_, rest_, particles_, 1e-4));
  EXPECT_THROW(write(), Error);
  settings_.material.breaking_strain.reset();
  settings_.material.yield_strain = 0.1;
  simulation_.emplace(test::simulation_from(settings_, rest_, particles_, 1e-4));
  EXPECT_THROW(write(), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path));
}

World moving_world() {
  World world;
  Obstacle ball{"ball", SphereShape{Vec3(1, 2, 3), 0.5}, {}, 2e3, 0.3, 0.4, 0.2};
  ball.motion = [](double time, const Pose& pose) {
    ObstaclePose now;
    now.frame = pose[1].frame;
    now.velocity = Vec3(time, 0, 1);
    return now;
  };
  world.obstacles = {ball};
  world.fields = {{"swirl",
                   Swirl{Vec3(1, 0, 0), Vec3::UnitY(), 3, 0.2},
                   Region{BoxShape{Vec3::Ones()}, 0.1},
                   {{0, 1}, {2, 4}}}};
  world.supports = {{"grip", {3, 4}, {true, false, true}, {}, Vec3(1, 1, 1)}};
  world.loads = {{"load", {}, {5, 7}, {0.25, 0.75}, Vec3(0, 0, 8)}};
  world.pins = {{1, 1}, {2}};
  hold(world, 10);
  return world;
}

TEST_F(EngineFiles, HoldAWorld) {
  const World world = moving_world();
  const World read = unarchived<World>(archived(engine_world(world)));
  EXPECT_EQ(std::get<SphereShape>(read.obstacles[0].shape).center, Vec3(1, 2, 3));
  EXPECT_EQ(read.obstacles[0].stick, 0.2);
  EXPECT_EQ(std::get<Swirl>(read.fields[0].form).core, 0.2);
  EXPECT_TRUE(std::holds_alternative<BoxShape>(*read.fields[0].region.shape));
  EXPECT_EQ(read.pins.size(), world.pins.size());
  EXPECT_EQ(read.supports[0].holds, world.supports[0].holds);
}

TEST_F(EngineFiles, SayWhereObstaclesAndSupportsAreAtEveryStep) {
  const World world = moving_world(), told = engine_world(world);
  const Skeleton& skeleton = simulation().body().skeleton;
  const Motion motion = motion_of(settings_, skeleton);
  const StepPlan plan(1e-3, 10, std::vector<int>(100, 2));
  write_engine_poses(folder_.path / "poses", world, skeleton, motion, plan, 100, 900);
  EngineWorld there(folder_.path / "poses", told, 100);
  for (const std::int64_t step : {100, 101, 355, 356, 357, 899, 900, 120}) {
    const double time = plan.time(step);
    there.go_to(step, time);
    const WorldNow now = world_at(world, time, pose_at(skeleton, motion, time));
    EXPECT_EQ(there.now().obstacles[0].frame.rotation, now.obstacles[0].frame.rotation);
    EXPECT_EQ(there.now().obstacles[0].velocity, now.obstacles[0].velocity);
    EXPECT_EQ(there.now().supports[0].frame.origin, now.supports[0].frame.origin);
    EXPECT_EQ(there.now().scales, now.scales);
    EXPECT_EQ(there.load(7), Vec3(0, 0, 6));
  }
  EXPECT_THROW(there.go_to(901, plan.time(901)), Error);
  EXPECT_EQ(there.held(0), nullptr);
  EXPECT_EQ(there.held(1)->bone, 1);
  EXPECT_FALSE(there.held(4)->holds(1));
}

TEST_F(EngineFiles, KnowNoMeshesMusclesAndPressures) {
  const auto is_refused = [&](const World& world) {
    Body body = simulation().body();
    body.world = std::make_shared<const World>(world);
    return conflict_with(Feature::lammps, features_of(body)).has_value();
  };
  World world;
  EXPECT_FALSE(is_refused(world));
  world.obstacles.push_back({"mesh", MeshShape{}, {}});
  EXPECT_TRUE(is_refused(world));
  world = {};
  world.loads.resize(1);
  world.loads[0].pressure = 1;
  EXPECT_TRUE(is_refused(world));
  world = {};
  world.muscles.active = {0};
  EXPECT_TRUE(is_refused(world));
}

TEST_F(EngineFiles, AreRefusedWhereTheyAreTruncated) {
  write();
  for (const auto& file : {folder_.setup(), folder_.particles()}) {
    const std::string whole = read_file(file);
    write_file(file, whole.substr(0, whole.size() - 1));
    try {
      for_each_engine_particle(folder_, read_engine_setup(folder_), [](const EngineParticle&) {});
      ADD_FAILURE() << file;
    } catch (const Error& error) {
      EXPECT_TRUE(std::string_view(error.what()).starts_with(file.string())) << error.what();
    }
    write_file(file, whole);
  }
}

TEST_F(EngineFiles, BringStatesBack) {
  write_state(rest_.size());
  const SimulationState state = read_engine_state(folder_, 7, simulation().save(), ids());
  EXPECT_EQ(state.steps, 7);
  Simulation other = test::simulation_from(settings_, rest_, particles_, 1e-4);
  other.restore(state);
  EXPECT_EQ(other.particles().position(3), Vec3(3, 2, 3));
  EXPECT_EQ(other.particles().velocity(3), Vec3(4, 5, 6));
  remove_engine_state(folder_, 7, 1);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path));
}

TEST_F(EngineFiles, RefuseStatesThatLackParticles) {
  write_state(rest_.size() - 1);
  EXPECT_THROW(read_engine_state(folder_, 7, simulation().save(), ids()), Error);
}

TEST(EngineTalk, IsReadAsItIsSaid) {
  for (const bool unstable : {false, true}) {
    const auto news = news_of(text_of({1200, unstable}));
    ASSERT_TRUE(news);
    EXPECT_EQ(news->steps, 1200);
    EXPECT_EQ(news->unstable, unstable);
  }
  for (const char* other : {"", "LAMMPS (29 Sep 2021)", "sinew-engine: state",
                            "sinew-engine: state 1x", "sinew-engine: begins"})
    EXPECT_FALSE(news_of(other)) << other;
}

}  // namespace sinew::engine_files_test
