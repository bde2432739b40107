// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of particles that move as one: what they must not change, and what they keep.
#include <gtest/gtest.h>
#include <numeric>

#include <sinew/body/grouping.h>
#include <sinew/core/parallel.h>
#include <sinew/groups/cubic/quadrature.h>
#include <sinew/kernel/kernel.h>
#include <sinew/material/laws.h>

#include "support/expect_error.h"
#include "support/grouped_bar.h"

namespace sinew::groups_test {

/// Two groups that touch in the middle of a bar, and free particles around both.
std::int32_t two_in_the_middle(const Vec3& X, int width, int height) {
  const double s = half_plane_spacing(r), z = X.z() / s - 0.5;
  const bool across =
      std::abs(X.x()) < (width / 2 - 3.5) * s && std::abs(X.y()) < (width / 2 - 3.5) * s;
  if (!across || z < 4 || z > height - 5) return -1;
  return z < height / 2 ? 3 : 8;
}

Bar bar_of(const Settings& settings, int width = 25, int height = 41) {
  return Bar(settings, width, height,
             [&](const Vec3& X) { return two_in_the_middle(X, width, height); });
}

bool is_deep(const Bar& bar, std::size_t i) {
  const Box box = bounds(bar.rest);
  const Vec3 in = (bar.rest[i] - box.min()).cwiseMin(box.max() - bar.rest[i]);
  return in.minCoeff() > 4.5 * half_plane_spacing(r) / std::numbers::sqrt2;
}

TEST(Groups, LayersAreNumberedFromTheRimToTheCore) {
  for (const MaterialModel model : models) {
    const Bar bar = bar_of(scene_of(model));
    ASSERT_EQ(bar.body.grouping->size(), 2U);
    std::array<std::size_t, 4> of_layer{};
    for (std::size_t i = 0; i < bar.rest.size(); ++i)
      ++of_layer[static_cast<std::size_t>(bar.layer(i))];
    EXPECT_EQ(of_layer[1] + of_layer[2] + of_layer[3], bar.body.grouping->grouped());
    EXPECT_GT(of_layer[2], 0U);
    EXPECT_GT(of_layer[3], 0U);
  }
}

TEST(Groups, AnEvenStrainPassesThroughTheirFaces) {
  Mat3 F = test::turned({1, 2, 3}, 25), L;
  F *= Vec3(1.02, 0.99, 1.01).asDiagonal();
  F(0, 1) += 0.01;
  L << 0.1, -0.3, 0.2, 0.5, -0.1, 0.4, 0.2, 0.3, 0.15;
  for (const MaterialModel model : models)
    for (const DampingForm form : {DampingForm::paper, DampingForm::central}) {
      Bar bar = bar_of(test::unbound(scene_of(model, form)));
      bar.body.factors.volume_weight.clear();  // near surfaces, others exert forces
      for (std::size_t i = 0; i < bar.rest.size(); ++i) {
        bar.particles.set_position(i, F * bar.rest[i]);
        bar.particles.set_velocity(i, L * bar.rest[i]);
      }
      Simulation simulation = bar.begin();
      const Forces& forces = simulation.forces();
      const double scale = bar.body.material.stiffness() * r;
      double most = 0, constraint = 0;
      for (std::size_t i = 0; i < bar.rest.size(); ++i) {
        if (is_deep(bar, i)) most = std::max(most, forces.total(i).norm());
        constraint = std::max(constraint, forces.group[i].norm());
      }
      EXPECT_LT(most, 1e-10 * scale);
      EXPECT_LT(constraint, 1e-10 * scale);
      simulation.step();
      const Particles& after = simulation.particles();
      double off = 0;
      for (std::size_t i = 0; i < bar.rest.size(); ++i)
        if (is_deep(bar, i))
          off = std::max(off, (after.position(i) - (F + bar.step * L) * bar.rest[i]).norm());
      EXPECT_LT(off, 1e-10 * r);
    }
}

TEST(Groups, KeepMomentum) {
  for (const MaterialModel model : models) {
    Bar bar = bar_of(test::unbound(scene_of(model, DampingForm::central)));
    bar.particles = test::shaken(bar.rest, bar.body.material, 0.02 * r, 0.05);
    Simulation simulation = bar.begin();
    const Conserved before = conserved(simulation.particles());
    for (int step = 0; step < 200; ++step) simulation.step();
    const Conserved after = conserved(simulation.particles());
    const double scale = 0.05 * static_cast<double>(bar.rest.size());
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-13 * scale);
    EXPECT_LT((after.angular - before.angular).norm(),
              1e-12 * scale * bounds(bar.rest).sizes().norm());
  }
}

TEST(Groups, AllOfABodyTurnsAsItWouldAlone) {
  for (const Precision precision : test::precisions) {
    Bar bar(test::unbound(scene_of(MaterialModel::bonded, DampingForm::paper, precision)), 13, 21,
            [](const Vec3&) { return 0; });
    const Vec3 spin(0.5, -1, 2), velocity(0.3, 0, 1);
    for (std::size_t i = 0; i < bar.rest.size(); ++i)
      bar.particles.set_velocity(i, velocity + spin.cross(bar.rest[i]));
    Simulation grouped = bar.begin();
    bar.body.grouping.reset();
    Simulation alone = bar.begin();
    for (int step = 0; step < 300; ++step) grouped.step(), alone.step();
    EXPECT_LT(test::largest_distance(grouped.particles(), alone.particles()), 0.05 * r);
    EXPECT_EQ(grouped.list_counts().outer, 0);
    EXPECT_GT(alone.list_counts().outer, 0);
    EXPECT_NEAR(grouped.energies().kinetic, alone.energies().kinetic,
                1e-3 * alone.energies().kinetic);
  }
}

/// The fraction of a wave's energy that a group as thick as `fraction` of its length throws back:
/// what moves before the group, beside a bar without, once the wave has passed. The wave is of 20
/// diameters along a bar, and at first goes both ways.
double thrown_back(MaterialModel model, double fraction, bool cubic = false) {
  constexpr double length = 40 * r, from = 4 * length, group_at = 6 * length, until = 7 * length;
  Settings settings = test::unbound(scene_of(model));
  settings.material.damping = 0;
  const double thickness = fraction * length;
  Bar bar(settings, 9, static_cast<int>(9 * length / half_plane_spacing(r)),
          [&](const Vec3& X) { return std::abs(X.z() - group_at) < thickness / 2 ? 0 : -1; });
  bar = with_cubic(bar, cubic);
  const auto wave = [](double z) {
    const double along = (z - from) / length;
    return 0.1 * r * std::exp(-along * along) * std::sin(2 * std::numbers::pi * along);
  };
  const double poisson = bar.body.material.constants().C12 /
                         (bar.body.material.constants().C11 + bar.body.material.constants().C12);
  for (std::size_t i = 0; i < bar.rest.size(); ++i) {
    const Vec3& X = bar.rest[i];
    const double strain = (wave(X.z() + r) - wave(X.z() - r)) / (2 * r);
    bar.particles.x[i] -= poisson * strain * X.x();
    bar.particles.y[i] -= poisson * strain * X.y();
    bar.particles.z[i] += wave(X.z());
  }
  Simulation grouped = bar.begin();
  bar.body.grouping.reset();
  Simulation alone = bar.begin();
  const auto moves = [&](const Points& v, double low, double high) {
    double sum = 0;
    for (std::size_t i = 0; i < v.size(); ++i)
      if (bar.rest[i].z() > low && bar.rest[i].z() < high) sum += v[i].squaredNorm();
    return sum;
  };
  const auto velocities = [](const Particles& particles) {
    Points v;
    for (std::size_t i = 0; i < particles.size(); ++i) v.push_back(particles.velocity(i));
    return v;
  };
  constexpr double all = std::numeric_limits<double>::infinity();
  Points full;
  do {
    for (int k = 0; k < 20; ++k) alone.step();
    full = velocities(alone.particles());
  } while (moves(full, until, all) < 0.25 * moves(full, 0, all));
  while (grouped.steps() < alone.steps()) grouped.step();
  Points off = velocities(grouped.particles());
  for (std::size_t i = 0; i < off.size(); ++i) off[i] -= full[i];
  return moves(off, from, group_at - thickness) / moves(full, group_at, all);
}

TEST(Groups, LetWavesPassThatAreLong) {
  for (const MaterialModel model : models) {
    EXPECT_LT(thrown_back(model, 0.125), 0.005);
    EXPECT_LT(thrown_back(model, 0.25), 0.05);
  }
  EXPECT_LT(thrown_back(MaterialModel::bonded, 0.25, true), 0.001);
  EXPECT_LT(thrown_back(MaterialModel::bonded, 0.5, true), 0.05);
}

/// Both halves of a bar that bends are grouped, but for the middle.
Bar bending(MaterialModel model, DampingForm form, Precision precision, int width = 25,
            int height = 81) {
  Settings settings = test::in(precision, test::box_scene(height));
  settings.material.model = model;
  settings.material.damping_form = form;
  settings.solver.gravity = {0, 1, -2};
  settings.tracks = {test::track("lower", {test::bend_key(0, 0), test::bend_key(0.3, -10)}),
                     test::track("upper", {test::bend_key(0, 0), test::bend_key(0.3, 50)})};
  const double s = half_plane_spacing(r);
  return Bar(settings, width, height, [&](const Vec3& X) {
    const double z = X.z() / s - 0.5;
    return z < height / 2 - width * 0.5 ? 0 : z > height / 2 + width * 0.5 ? 1 : -1;
  });
}

struct Results {
  std::uint64_t state;
  std::vector<double> energies;
  Points pair, bone, group;

  bool operator==(const Results&) const = default;
};

Results results_of(Simulation& simulation) {
  const Energies energies = simulation.energies();
  const Forces& forces = simulation.forces();
  return {state_hash(simulation.particles()),
          {energies.kinetic, energies.pair, energies.bone, energies.work_of_bones,
           energies.dissipation},
          forces.pair,
          forces.bone,
          forces.group};
}

TEST(Groups, TheSameBitsOnAnyNumberOfThreadsAndInstructions) {
  for (const Precision precision : test::precisions)
    for (const MaterialModel model : models) {
      const Bar bar = bending(model, DampingForm::central, precision);
      std::vector<Results> results;
      for (const int threads : {1, 2, 3})
        with_threads(threads, [&] {
          Simulation simulation =
              bar.begin(test::instruction_sets()[static_cast<std::size_t>(threads) %
                                                 test::instruction_sets().size()]);
          for (int step = 0; step < 80; ++step) simulation.step();
          results.push_back(results_of(simulation));
        });
      EXPECT_EQ(results[0], results[1]);
      EXPECT_EQ(results[0], results[2]);
    }
}

TEST(Groups, ASavedOneContinuesWithTheSameBits) {
  for (const Precision precision : test::precisions)
    for (const MaterialModel model : models) {
      const Bar bar = bending(model, DampingForm::symmetric, precision);
      Simulation whole = bar.begin(), first = bar.begin(), second = bar.begin();
      for (int step = 0; step < 70; ++step) whole.step();
      for (int step = 0; step < 33; ++step) first.step();
      second.restore(first.save());
      while (second.steps() < 70) second.step();
      EXPECT_EQ(results_of(whole), results_of(second));
    }
}

TEST(Groups, ABendIsNearlyTheSame) {
  for (const Precision precision : test::precisions)
    for (const MaterialModel model : models)
      EXPECT_LT(off_from_full(bending(model, DampingForm::paper, precision), 0.3), 1);
}

TEST(Groups, TheLedgerOfABendCloses) {
  Simulation simulation =
      bending(MaterialModel::bonded, DampingForm::paper, Precision::binary64).begin();
  const double start = simulation.energies().stored();
  while (simulation.time() < 0.3) simulation.step();
  const Energies now = simulation.energies();
  EXPECT_NEAR(now.stored() - start, now.work() - now.dissipation, 0.01 * now.work_of_bones);
}

TEST(Groups, ASqueezeThatFurtherNeighborsWouldFeelEndsTheRun) {
  Bar bar = bar_of(test::unbound(scene_of(MaterialModel::paper)));
  for (std::size_t i = 0; i < bar.rest.size(); ++i)
    bar.particles.set_position(i, Vec3(0.91, 1, 1).cwiseProduct(bar.rest[i]));
  Simulation simulation = bar.begin();
  test::expect_error(Exit::unstable, [&] { simulation.step(); }, {"squeezed to 0.91"});
}

TEST(Groups, AStretchAtWhichNeighborsPartEndsTheRun) {
  Bar bar = bar_of(test::unbound(scene_of(MaterialModel::paper)));
  for (std::size_t i = 0; i < bar.rest.size(); ++i)
    bar.particles.set_position(i, Vec3(1, 1.31, 1).cwiseProduct(bar.rest[i]));
  Simulation simulation = bar.begin();
  test::expect_error(Exit::unstable, [&] { simulation.step(); }, {"stretched to 1.31"});
}

// Groups of a scene.

Prepared grouped(Settings settings) {
  settings.hierarchy.enabled = true;
  return test::prepared(settings, test::fcc_box(25, 25, 81, r));
}

Settings bending_scene() {
  Settings settings = test::box_scene(81);
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(1, 50)})};
  return settings;
}

TEST(StaticGroups, AreFreeNearAJointThatMoves) {
  const Prepared prepared = grouped(bending_scene());
  const Grouping& grouping = *prepared.body.grouping;
  ASSERT_EQ(grouping.size(), 2U);
  const double joint = prepared.body.skeleton.bones[1].head().z();
  const double free = std::sqrt(prepared.body.binding.cross_section[1]);
  for (std::size_t i = 0; i < prepared.body.rest.size(); ++i)
    EXPECT_EQ(grouping.group[i] < 0, std::abs(prepared.body.rest[i].z() - joint) < free) << i;
}

TEST(StaticGroups, AreOneWhereNoJointMoves) {
  const Prepared prepared = grouped(test::box_scene(81));
  EXPECT_EQ(prepared.body.grouping->size(), 1U);
  EXPECT_EQ(prepared.body.grouping->grouped(), prepared.body.rest.size());
}

TEST(StaticGroups, RefuseWhatTheyCannotBeCombinedWith) {
  const auto expect = [](const std::string& message, const auto& change) {
    Settings settings = bending_scene();
    change(settings);
    test::expect_bad_input([&] { grouped(settings); }, {message});
  };
  expect("only in fcc are", [](Settings& s) { s.body.packing = Packing::hcp; });
  expect("free particles", [](Settings& s) { s.solver.method = Method::static_equilibrium; });
  expect("the paper's cells and groups",
         [](Settings& s) { s.solver.neighbor_search = NeighborSearch::cells; });
  expect("drag and groups", [](Settings& s) { s.world.drag = 1; });
  expect("did you mean 'upper'", [](Settings& s) { s.hierarchy.free_bones = "lower, uper"; });
  expect("no particle is in it", [](Settings& s) {
    s.hierarchy.free_region = {{5, 5, 5, 6, 6, 6}};
  });
  expect("bonds that relax and groups", [](Settings& s) {
    s.material.model = MaterialModel::bonded;
    s.material.relaxation_shares = {{0.5}};
    s.material.relaxation_times = {{0.1}};
  });
  expect("do not rub", [](Settings& s) {
    s.material.model = MaterialModel::bonded;
    s.material.friction = 0.5;
  });
  expect("bonds that break and groups", [](Settings& s) {
    s.material.model = MaterialModel::bonded;
    s.material.breaking_strain = 0.2;
  });
}

TEST(StaticGroups, RefuseAnotherMotion) {
  const Settings settings = bending_scene();
  Prepared prepared = grouped(settings);
  const Motion motion = prepared.motion;
  Simulation simulation = start(std::move(prepared));
  const auto play = [&] { simulation.play(motion); };
  test::expect_bad_input(play, {"groups of particles", "; set hierarchy.enabled to false"});
}

// Sums from a sample of blocks.

/// 20 x 20 x 20 blocks of one particle.
std::vector<SampledBlock> cube_of_blocks(Points& places) {
  std::vector<SampledBlock> blocks;
  for (int k = 0; k < 8000; ++k) {
    const Vec3 X = Vec3(k % 20 - 9.5, k / 20 % 20 - 9.5, k / 400 - 9.5) / 10;
    blocks.push_back({static_cast<std::uint32_t>(k), 0});
    places.push_back(X);
  }
  return blocks;
}

TEST(Quadrature, IsExactToTheFourthOrderAndNearlySoForWhatIsSmooth) {
  Points X;
  const std::vector<SampledBlock> blocks = cube_of_blocks(X);
  const Quadrature quadrature =
      quadrature_over(blocks, [&](std::uint32_t block) { return Points{X[block]}; });
  EXPECT_LT(quadrature.block.size(), 400U);
  const auto error = [&](const auto& f) {
    double all = 0, sampled = 0, size = 0;
    for (const Vec3& x : X) all += f(x), size += std::abs(f(x));
    for (std::size_t s = 0; s < quadrature.block.size(); ++s)
      sampled += quadrature.weight[s] * f(X[quadrature.block[s]]);
    return std::abs(sampled - all) / size;
  };
  EXPECT_LT(error([](const Vec3&) { return 1.0; }), 1e-12);
  EXPECT_LT(error([](const Vec3& x) { return x.x() * x.y() * x.z() + x.x() * x.x() - x.z(); }),
            1e-12);
  EXPECT_LT(error([](const Vec3& x) { return x.x() * x.x() * x.y() * x.z() + std::pow(x.z(), 4); }),
            1e-12);
  EXPECT_LT(error([](const Vec3& x) { return std::cos(2 * x.x() + x.y()); }), 0.01);
  EXPECT_LT(error([](const Vec3& x) { return std::hypot(x.x(), x.y()); }), 0.01);
}

TEST(Quadrature, OfAPartOfAGroupIsASmallSample) {
  for (int part = 0; part < 20; ++part) {
    const Vec3 corner(0.1 * part, 1.5 - 0.05 * part, 1), size(0.02 + 0.01 * part, 0.1, 0.3);
    Points X;
    std::vector<SampledBlock> blocks = cube_of_blocks(X);
    blocks.resize(static_cast<std::size_t>(600 + 300 * part));
    const auto at = [&](std::uint32_t block) { return Vec3(corner + size.cwiseProduct(X[block])); };
    const Quadrature quadrature =
        quadrature_over(blocks, [&](std::uint32_t block) { return Points{at(block)}; });
    EXPECT_LE(quadrature.block.size(), 200U) << part;
    Vec3 all = Vec3::Zero();
    for (const SampledBlock& one : blocks) all += at(one.block).cwiseProduct(at(one.block));
    for (std::size_t s = 0; s < quadrature.block.size(); ++s) {
      const Vec3 x = at(quadrature.block[s]);
      all -= quadrature.weight[s] * x.cwiseProduct(x);
    }
    EXPECT_LT(all.norm(), 1e-9 * static_cast<double>(blocks.size()));
  }
}

TEST(Groups, RefuseALawThatAProgramBrings) {
  Bar bar = bar_of(scene_of(MaterialModel::bonded), 9, 17);
  const kernel::OwnLaw steps{};
  ForceLaw law = law_of(bar.body.material);
  law.name = "mine", law.kernel = &steps;
  bar.body.material.law = &law;
  test::expect_bad_input([&] { check_groupable(bar.body); },
                         {"a law that a program brings", "groups of particles"});
}

}  // namespace sinew::groups_test
