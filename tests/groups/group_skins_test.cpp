// SPDX-License-Identifier: GPL-3.0-or-later
// Skins of groups: what follows from the motion of a group, and what touches it.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "support/grouped_bar.h"

namespace sinew::group_skins_test {

using namespace groups_test;
namespace {

/// Accelerations by all forces on particles of a body that is one group, and by a step with them.
struct Accelerations {
  Vec3 expected, found;
  Mat3 expected_F, found_F;
};

Accelerations accelerations(const Bar& bar) {
  Simulation simulation = bar.begin();
  const auto count = static_cast<double>(bar.rest.size());
  Vec3 center = Vec3::Zero();
  for (const Vec3& X : bar.rest) center += X / count;
  const Forces& forces = simulation.forces();
  Accelerations a{Vec3::Zero(), Vec3::Zero(), Mat3::Zero(), Mat3::Zero()};
  Mat3 spread = Mat3::Zero();
  for (std::size_t i = 0; i < bar.rest.size(); ++i) {
    const Vec3 X = bar.rest[i] - center;
    const Vec3 f = (forces.total(i) - forces.group[i]) / bar.particles.mass;
    a.expected += f / count, a.expected_F += f * X.transpose(), spread += X * X.transpose();
  }
  a.expected_F = (a.expected_F * spread.inverse()).eval();
  const Particles before = simulation.particles();
  simulation.step();
  const Particles& after = simulation.particles();
  for (std::size_t i = 0; i < bar.rest.size(); ++i) {
    const Vec3 f = (after.velocity(i) - before.velocity(i)) / bar.step;
    a.found += f / count;
    a.found_F += f * (bar.rest[i] - center).transpose();
  }
  a.found_F = (a.found_F * spread.inverse()).eval();
  return a;
}

TEST(GroupSkins, FollowFromTheMotionOfTheirGroup) {
  Mat3 F = test::turned({1, 2, 3}, 25), L;
  F *= Vec3(1.05, 0.97, 1.02).asDiagonal();
  F(0, 1) += 0.03;
  L << 0.1, -0.3, 0.2, 0.5, -0.1, 0.4, 0.2, 0.3, 0.15;
  for (const MaterialModel model : models)
    for (const bool isotropic : {true, false}) {
      Settings settings = test::unbound(scene_of(model));
      settings.material.isotropic = isotropic;
      Bar bar(settings, 17, 23, [](const Vec3& X) { return X.norm() < 100 ? 0 : -1; });
      for (std::size_t i = 0; i < bar.rest.size(); ++i) {
        bar.particles.set_position(i, F * bar.rest[i]);
        bar.particles.set_velocity(i, L * bar.rest[i]);
      }
      const Accelerations a = accelerations(bar);
      const double size = a.expected_F.norm();
      EXPECT_GT(size, 1);
      EXPECT_LT((a.found - a.expected).norm(), 1e-9 * size * r);
      EXPECT_LT((a.found_F - a.expected_F).norm(), 1e-9 * size);
    }
}

TEST(GroupSkins, KeepMomentumAndEnergyWhenTheyCollide) {
  for (const MaterialModel model : models)
    for (const bool free : {true, false}) {
      Settings settings = scene_of(model);
      settings.material.damping = 0;
      expect_elastic_collision(colliding(settings, free));
    }
}

/// Beside an obstacle far away, skins are computed like rims.
Bar with_computed_skins(Bar bar) {
  World world;
  Obstacle far;
  far.shape = PlaneShape{{0, 0, -1e3}, {0, 0, 1}};
  far.stiffness = 1;
  world.obstacles = {far};
  bar.body.world = std::make_shared<const World>(world);
  std::vector<std::int32_t> group = bar.body.grouping->group;
  bar.body.grouping = std::make_shared<const Grouping>(make_grouping(bar.body, std::move(group)));
  return bar;
}

TEST(GroupSkins, MoveAsIfTheyWereComputed) {
  for (const Precision precision : test::precisions)
    for (const MaterialModel model : models) {
      const Bar bar = colliding(scene_of(model, DampingForm::paper, precision), true);
      const Bar computed_bar = with_computed_skins(bar);
      Simulation followed = bar.begin(), computed = computed_bar.begin();
      ASSERT_LT(computed_bar.body.grouping->inside(), bar.body.grouping->inside());
      for (int step = 0; step < 400; ++step) followed.step(), computed.step();
      EXPECT_LT(test::largest_distance(followed.particles(), computed.particles()),
                (precision == Precision::binary64 ? 1e-7 : 0.02) * r);
      EXPECT_NEAR(followed.energies().dissipation, computed.energies().dissipation,
                  0.02 * computed.energies().dissipation);
    }
}

TEST(GroupSkins, CollideWithTheSameBitsOnAnyNumberOfThreadsAndAfterASave) {
  for (const Precision precision : test::precisions) {
    const Bar bar = colliding(scene_of(MaterialModel::paper, DampingForm::paper, precision), false);
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 3})
      with_threads(threads, [&] {
        Simulation simulation = bar.begin();
        for (int step = 0; step < 400; ++step) {
          simulation.step();
          if (threads == 3 && step % 7 == 0) {
            Simulation resumed = bar.begin();
            resumed.restore(simulation.save());
            simulation = std::move(resumed);
          }
        }
        hashes.push_back(state_hash(simulation.particles()));
      });
    EXPECT_EQ(hashes[0], hashes[1]);
  }
}

}  // namespace
}  // namespace sinew::group_skins_test
