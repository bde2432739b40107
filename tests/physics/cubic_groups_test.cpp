// SPDX-License-Identifier: GPL-3.0-or-later
// Groups that move by cubics of the place: they bend, and keep what affine ones keep.
#include <gtest/gtest.h>

#include <sinew/core/parallel.h>
#include <sinew/physics/hierarchy/polynomials.h>
#include <sinew/scene/setup.h>

#include "expect_error.h"
#include "grouped_bar.h"

namespace sinew::groups_test {

/// The same bar, whose groups are cubic.
Bar cubic(Bar bar) {
  auto grouping = std::make_shared<Grouping>(*bar.body.grouping);
  grouping->cubic_from = 0;
  bar.body.grouping = grouping;
  return bar;
}

Settings bonded(Precision precision = Precision::binary64) {
  return scene_of(MaterialModel::bonded, DampingForm::paper, precision);
}

/// A group at each end of a bar, as wide as the bar, and free particles between them.
Bar with_groups_at_ends(const Settings& settings, int width = 17, int height = 61) {
  const double s = half_plane_spacing(r);
  return cubic(Bar(settings, width, height, [&](const Vec3& X) {
    const double z = X.z() / s - 0.5;
    return z < height / 2 - width * 0.5 ? 0 : z > height / 2 + width * 0.5 ? 1 : -1;
  }));
}

Bar bending(Precision precision = Precision::binary64) {
  Settings settings = test::in(precision, test::box_scene(81));
  settings.material.model = MaterialModel::bonded;
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
    EXPECT_LT((slopes_at(at, axis) - slope).norm(), 1e-9);
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

/// Accelerations of groups in a step are those that forces on all of their particles give them.
TEST(CubicGroups, MoveByTheForcesOnAllOfTheirParticles) {
  Bar bar = with_groups_at_ends(test::unbound(bonded()));
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
  EXPECT_LT(std::sqrt(off / size), 2e-3);
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

TEST(CubicGroups, ABendIsNearerThanThatOfAffineOnes) {
  Bar bar = bending();
  const double bent = off_from_full(bar, 0.3);
  auto grouping = std::make_shared<Grouping>(*bar.body.grouping);
  grouping->cubic_from = std::numeric_limits<std::size_t>::max();
  bar.body.grouping = grouping;
  EXPECT_LT(bent, 0.6 * off_from_full(bar, 0.3));
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

}  // namespace sinew::groups_test
