// SPDX-License-Identifier: GPL-3.0-or-later
// What a bone carries by its springs, by pins on it and by obstacles that ride on it, beside the
// weight of the body and the law of action and reaction.
#include <gtest/gtest.h>

#include "support/world.h"

namespace sinew::bone_reactions_test {

constexpr double r = 0.01, g = 9.81;

/// A bonded bar of 5 x 5 x 15 half-planes that no spring of a bone holds, under gravity.
Settings heavy_bar() {
  Settings settings = test::unbound(test::box_scene(15));
  settings.binding.bone_damping = 0;
  settings.material.model = MaterialModel::bonded;
  settings.material.damping_form = DampingForm::symmetric;
  settings.material.young_modulus = 1e5;
  settings.world.drag = 30;  // 1/s: it comes to rest soon
  settings.solver.gravity = Vec3(0, 0, -g);
  return settings;
}

Points bar() { return test::fcc_box(5, 5, 15, r); }

/// The same after `steps`, while it comes to rest.
Simulation settled(const Settings& settings, int steps) {
  Simulation simulation = test::make_simulation(settings, bar());
  while (simulation.steps() < steps) simulation.step();
  return simulation;
}

double weight(const Simulation& simulation) {
  return static_cast<double>(simulation.particles().size()) * simulation.particles().mass * g;
}

void expect_carried(Simulation& simulation, const std::vector<Reaction>& part) {
  const std::vector<Reaction> sums = simulation.reactions_of_bones().sums();
  const double W = weight(simulation);
  ASSERT_EQ(part.size(), 2U);
  EXPECT_LT((part[1].force - Vec3(0, 0, -W)).norm(), 1e-6 * W);
  EXPECT_LT(part[1].moment.norm(), 1e-6 * W * r);
  EXPECT_LT((sums[1].force - part[1].force).norm(), 1e-12 * W);
  EXPECT_LT(sums[0].force.norm(), 1e-12 * W);
}

TEST(BoneReactions, OfPinsCarryTheWeightThatHangsOnThem) {
  for (const NeighborSearch search : {NeighborSearch::lists, NeighborSearch::cells}) {
    Settings settings = heavy_bar();
    settings.solver.neighbor_search = search;
    PinSettings pin;
    pin.region.low = Vec3(-1, -1, 14 * half_plane_spacing(r));
    pin.region.high = Vec3(1, 1, 1);
    pin.bone = "upper";
    settings.world.pins = {pin};
    Simulation simulation = settled(settings, 6000);
    expect_carried(simulation, simulation.reactions_of_bones().pins);
  }
}

TEST(BoneReactions, OfObstaclesThatRideOnItCarryWhatStandsOnThem) {
  Settings settings = heavy_bar();
  ObstacleSettings floor;
  floor.name = "floor";
  floor.shape = ObstacleShape::plane;
  floor.point = Vec3::Zero();
  floor.normal = Vec3::UnitZ();
  floor.bone = "upper";
  settings.world.obstacles = {floor};
  Simulation simulation = settled(settings, 8000);
  expect_carried(simulation, simulation.reactions_of_bones().obstacles);
}

/// A bone that turns and lifts a pinned bar: what the pins put on it is what the other forces put
/// on the pinned particles, and the power is that of its rigid motion.
TEST(BoneReactions, OfPinsAnswerAllOtherForcesOnThePinned) {
  Settings settings = heavy_bar();
  settings.world.drag = 0;
  PinSettings pin;
  pin.region.low = Vec3(-1, -1, 12 * half_plane_spacing(r));
  pin.region.high = Vec3(1, 1, 1);
  pin.bone = "upper";
  settings.world.pins = {pin};
  KeyDefinition end = test::bend_key(0.2, 40);
  end.translation = Vec3(0.01, 0, 0.02);
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), end})};
  Simulation simulation = settled(settings, 300);
  const Particles& now = simulation.particles();
  const Forces& forces = simulation.forces();
  const BonePose& bone = simulation.pose()[1];
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (const Pinned& one : simulation.body().world->pins) {
    const std::size_t i = one.particle;  // the particles are in the order of their ids
    const Vec3 others =
        forces.pair[i] + forces.damping[i] + forces.bone[i] + now.mass * settings.solver.gravity;
    force += others;
    moment += (now.position(i) - bone.frame.origin).cross(others);
  }
  const Reaction on = simulation.reactions_of_bones().pins[1];
  ASSERT_GT(force.norm(), 0.1 * weight(simulation));
  EXPECT_LT((on.force - force).norm(), 1e-12 * force.norm());
  EXPECT_LT((on.moment - moment).norm(), 1e-12 * force.norm());
  const double power = -(force.dot(bone.velocity) + moment.dot(bone.angular_velocity));
  EXPECT_NEAR(on.power, power, 1e-9 * std::abs(power));
}

}  // namespace sinew::bone_reactions_test
