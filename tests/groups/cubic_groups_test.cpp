// SPDX-License-Identifier: GPL-3.0-or-later
// Groups that move by cubics of the place: they bend, and keep what affine ones keep.
#include <gtest/gtest.h>

#include <sinew/core/parallel.h>
#include <sinew/groups/cubic/cubic_fits.h>
#include <sinew/groups/cubic/polynomials.h>
#include <sinew/scene/prepare.h>

#include "support/expect_error.h"
#include "support/grouped_bar.h"

namespace sinew::cubic_groups_test {

using namespace groups_test;

Settings bonded(Precision precision = Precision::binary64) {
  return scene_of(MaterialModel::bonded, DampingForm::paper, precision);
}

/// A group at each end of a bar, as wide as the bar, and free particles between them.
Bar with_groups_at_ends(const Settings& settings, int width = 17, int height = 61) {
  const double s = half_plane_spacing(r);
  const Bar bar(settings, width, height, [&](const Vec3& X) {
    const double z = X.z() / s - 0.5;
    return z < height / 2 - width * 0.5 ? 0 : z > height / 2 + width * 0.5 ? 1 : -1;
  });
  return with_cubic(bar, true);
}

Bar bending(Precision precision = Precision::binary64) {
  Settings settings = test::in(precision, test::box_scene(81));
  settings.material.model = MaterialModel::bonded;
  settings.material.damping_form = DampingForm::paper;
  settings.solver.gravity = {0, 1, -2};
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.3, 50)})};
  return with_groups_at_ends(settings, 25, 81);
}

TEST(Polynomials, GrowAsTheirTermsSay) {
  const Vec3 at(0.3, -0.7, 1.1), by(0.2, 0.5, -0.4);
  const Terms grown = terms_at(at + by) - terms_at(at);
  EXPECT_LT((growth_over(by) * square_terms_at(at) - grown).norm(), 1e-15 * grown.norm() * 10);
  for (int axis = 0; axis < 3; ++axis) {
    const double h = 1e-5;
    const Vec3 step = h * Vec3::Unit(axis);
    const Terms slope = (terms_at(at + step) - terms_at(at - step)) / (2 * h);
    EXPECT_LT((slopes_at(at).col(axis) - slope).norm(), 1e-9);
  }
}

TEST(CubicGroups, AnEvenStrainPassesThroughTheirFaces) {
  Mat3 F = test::turned({1, 2, 3}, 25);
  F *= Vec3(1.02, 0.99, 1.01).asDiagonal();
  F(0, 1) += 0.01;
  Bar bar = with_groups_at_ends(test::unbound(bonded()));
  for (std::size_t i = 0; i < bar.rest.size(); ++i) bar.particles.set_position(i, F * bar.rest[i]);
  Simulation grouped = bar.begin();
  const Forces& forces = grouped.forces();
  const Box box = bounds(bar.rest);
  double most = 0;
  for (std::size_t i = 0; i < bar.rest.size(); ++i) {
    const Vec3 in = (bar.rest[i] - box.min()).cwiseMin(box.max() - bar.rest[i]);
    if (bar.group(i) < 0 && in.minCoeff() > 4.5 * r) most = std::max(most, forces.total(i).norm());
  }
  EXPECT_LT(most, 1e-10 * bar.body.material.stiffness() * r);
}

/// How far the accelerations of groups in a step are from those that forces on all of their
/// particles give them, as a fraction; of a bar that is bent, and moves.
double off_the_forces(Bar bar) {
  const Box box = bounds(bar.rest);
  const double length = box.sizes().maxCoeff();
  for (std::size_t i = 0; i < bar.rest.size(); ++i) {
    const Vec3 X = bar.rest[i] / length;
    const Vec3 u(X.z() * X.z() + X.x() * X.y() * X.z(), X.z() * X.z() * X.z() - X.x() * X.z(),
                 X.x() * X.x() * X.y() - X.z() * X.x());
    bar.particles.set_position(i, bar.rest[i] + 0.02 * length * u);
    bar.particles.set_velocity(i, 0.3 * Vec3(X.y() * X.z(), X.x() * X.x() * X.z(), X.z() * X.z()));
  }
  Simulation simulation = bar.begin();
  const Forces forces = simulation.forces();
  const Particles before = simulation.particles();
  simulation.step();
  double off = 0, size = 0;
  for (std::size_t i = 0; i < bar.rest.size(); ++i) {
    if (bar.group(i) < 0) continue;
    const Vec3 a = forces.total(i) / bar.particles.mass;
    const Vec3 moved = (simulation.particles().velocity(i) - before.velocity(i)) / bar.step;
    off += (moved - a).squaredNorm(), size += a.squaredNorm();
  }
  return std::sqrt(off / size);
}

TEST(CubicGroups, MoveByTheForcesOnAllOfTheirParticles) {
  EXPECT_LT(off_the_forces(with_groups_at_ends(test::unbound(bonded()))), 2e-3);
}

/// Bones a hundred times as stiff as a scene's, each alone or two that share particles: the sample
/// of small groups is exact to the second order alone.
TEST(CubicGroups, MoveByWhatBonesExertOnAllOfTheirParticles) {
  for (const Precision precision : {Precision::binary64, Precision::binary32})
    for (const double zone : {0.0, 3.0}) {
      Settings settings = bonded(precision);
      settings.binding.joint_zone = zone;
      settings.binding.stiffness *= 100;
      settings.binding.twist_stiffness *= 100;
      settings.binding.axial_stiffness *= 100;
      EXPECT_LT(off_the_forces(with_groups_at_ends(settings)), 0.1) << zone;
    }
}

TEST(CubicGroups, KeepMomentum) {
  Settings settings = test::unbound(bonded());
  settings.material.damping = 0;
  Bar bar = with_groups_at_ends(settings);
  bar.particles = test::shaken(bar.rest, bar.body.material, 0.02 * r, 0.05);
  Simulation simulation = bar.begin();
  const Conserved before = conserved(simulation.particles());
  for (int step = 0; step < 200; ++step) simulation.step();
  const Conserved after = conserved(simulation.particles());
  const double scale = 0.05 * static_cast<double>(bar.rest.size());
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * scale);
}

TEST(CubicGroups, KeepMomentumAndEnergyWhenTheyCollide) {
  Settings settings = bonded();
  settings.material.damping = 0;
  for (const bool free : {true, false})
    expect_elastic_collision(with_cubic(colliding(settings, free), true));
}

TEST(CubicGroups, AreNoSheets) {
  for (const auto& [layers, cubic] : {std::pair{3, false}, std::pair{7, true}}) {
    const Bar bar(test::unbound(bonded()), test::fcc_box(61, 61, layers, r),
                  [](const Vec3&) { return 0; });
    std::vector<std::int32_t> group(bar.rest.size(), 5);
    const Grouping made = make_grouping(bar.body, group, 256);
    ASSERT_EQ(made.size(), 1U);
    EXPECT_EQ(made.cubic[0] != 0, cubic);
    EXPECT_EQ(make_grouping(bar.body, group, bar.rest.size() + 1).cubic[0], 0);
    free_sheets(bar.body, group);
    EXPECT_EQ(group[0], cubic ? 5 : -1);
  }
}

/// Bonds within cubic groups are known by where the lattice has neighbors.
TEST(CubicGroups, AreOfTheLatticeOfTheirBody) {
  Points rest = test::fcc_box(17, 17, 17, r);
  for (Vec3& X : rest) X = test::turned({0, 0, 1}, 30) * X;
  const auto inside = [&](MaterialModel model) {
    const Bar bar(test::unbound(scene_of(model)), rest, [](const Vec3&) { return 0; });
    return bar.body.grouping->inside();
  };
  EXPECT_GT(inside(MaterialModel::paper), 0U);
  EXPECT_EQ(inside(MaterialModel::bonded), 0U);
}

/// Particles in a box that are moved by a cubic, and off it by `off`, one way or the other.
TEST(CubicFits, TellACubicMotionAndHowFarParticlesAreFromIt) {
  const Points rest = test::fcc_box(17, 17, 33, r);
  const FitFrame frame(rest);
  Coefficients x, v;
  for (int k = 0; k < cubic_terms; ++k)
    for (int axis = 0; axis < 3; ++axis)
      x(k, axis) = std::sin(3 * k + axis), v(k, axis) = std::cos(k + 2 * axis);
  CubicSums some, all;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Terms terms = terms_at(frame.at(rest[i]));
    const double off = i % 2 == 0 ? 0.01 : -0.01;
    const Vec3 by(0, off, 0);
    all.add(terms, x.transpose() * terms, v.transpose() * terms);
    if (i % 3 == 0) some.add(terms, x.transpose() * terms + by, v.transpose() * terms + 2 * by);
  }
  const std::optional<CubicMotion> motion = cubic_motion(all);
  ASSERT_TRUE(motion);
  EXPECT_LT((motion->x - x).norm(), 1e-10);
  EXPECT_LT((motion->v - v).norm(), 1e-10);
  EXPECT_LT(residual(all, *motion).x, 1e-12);
  EXPECT_NEAR(residual(some, *motion).x, 1e-4, 1e-9);
  EXPECT_NEAR(residual(some, *motion).v, 4e-4, 1e-9);
}

TEST(CubicGroups, ABendIsNearerThanThatOfAffineOnes) {
  const Bar bar = bending();
  EXPECT_LT(off_from_full(bar, 0.3), 0.6 * off_from_full(with_cubic(bar, false), 0.3));
}

TEST(CubicGroups, TheLedgerOfABendCloses) {
  Simulation simulation = bending().begin();
  const double start = simulation.energies().stored();
  while (simulation.time() < 0.3) simulation.step();
  const Energies now = simulation.energies();
  EXPECT_NEAR(now.stored() - start, now.work() - now.dissipation, 0.01 * now.work_of_bones);
}

TEST(CubicGroups, TheSameBitsOnThreadsAndInstructionsAndAfterASave) {
  for (const Precision precision : test::precisions) {
    const Bar bar = bending(precision);
    std::vector<std::uint64_t> states;
    for (const int threads : {1, 2, 3})
      with_threads(threads, [&] {
        const auto sets = test::instruction_sets();
        Simulation simulation = bar.begin(sets[static_cast<std::size_t>(threads) % sets.size()]);
        for (int step = 0; step < 60; ++step) simulation.step();
        states.push_back(state_hash(simulation.particles()));
      });
    Simulation first = bar.begin(), second = bar.begin();
    for (int step = 0; step < 33; ++step) first.step();
    second.restore(first.save());
    while (second.steps() < 60) second.step();
    EXPECT_EQ(states[1], states[0]);
    EXPECT_EQ(states[2], states[0]);
    EXPECT_EQ(state_hash(second.particles()), states[0]);
  }
}

TEST(CubicGroups, ASqueezeThatTheyDoNotKnowEndsTheRun) {
  Bar bar = with_groups_at_ends(test::unbound(bonded()));
  const Mat3 across = test::turned({0, 0, 1}, 45);
  for (std::size_t i = 0; i < bar.rest.size(); ++i)
    bar.particles.set_position(
        i, across * Vec3(0.3, 1, 1).cwiseProduct(across.transpose() * bar.rest[i]));
  Simulation simulation = bar.begin();
  test::expect_error(Exit::unstable, [&] { simulation.step(); }, {"squeezed to 0.3"});
}

}  // namespace sinew::cubic_groups_test
