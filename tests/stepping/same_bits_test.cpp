// SPDX-License-Identifier: GPL-3.0-or-later
// The same bits from every instruction set and any number of threads, while lists are rebuilt.
#include <sinew/core/parallel.h>

#include "support/all_steppers.h"

namespace sinew::same_bits_test {

constexpr double r = 0.01;

/// A bend and a twist at once, with particles that two bones hold.
Settings bend_and_twist(int half_planes, Precision precision) {
  Settings settings = test::in(precision, test::box_scene(half_planes));
  settings.binding.joint_zone = 2;
  settings.solver.gravity = {0, 1, -2};
  KeyDefinition end = test::bend_key(0.2, 50);
  end.twist = 70;
  settings.tracks = {test::track("lower", {test::bend_key(0, 0), test::bend_key(0.2, -10)}),
                     test::track("upper", {test::bend_key(0, 0), end})};
  return settings;
}

/// All results of a run, bit by bit.
struct Results {
  std::uint64_t state;
  std::vector<double> energies;
  Points pair, damping, bone;
  std::vector<int> neighbors;
  std::int64_t rebuilds, surveys, listed, pruned, sorts;
  double outer, inner;

  bool operator==(const Results&) const = default;
};

Results results_of(Simulation& simulation) {
  const Energies energies = simulation.energies();
  const Forces& forces = simulation.forces();
  const ListCounts lists = simulation.list_counts();
  return {state_hash(simulation.particles()),
          {energies.kinetic, energies.gravity, energies.pair, energies.bone, energies.work_of_bones,
           energies.dissipation},
          forces.pair,
          forces.damping,
          forces.bone,
          forces.neighbors,
          lists.rebuilds,
          lists.surveys,
          lists.listed,
          lists.pruned,
          lists.sorts,
          lists.outer,
          lists.inner};
}

Results run(kernel::InstructionSet set, const Settings& settings, const Points& rest, int steps,
            double shake = 0, double speed = 0, double factor = 0.5) {
  const Body body = test::make_body(settings, rest);
  Simulation simulation =
      test::simulation_with(set, settings, rest, test::shaken(rest, body.material, shake, speed),
                            test::step_of(settings, body, factor));
  while (simulation.steps() < steps) simulation.step();
  return results_of(simulation);
}

TEST(SameBits, OfAllInstructionSetsOverABendWithATwist) {
  const Points rest = test::fcc_box(7, 7, 33, r);
  for (const Precision precision : test::precisions)
    for (const Integrator integrator :
         {Integrator::symplectic_euler, Integrator::velocity_verlet, Integrator::explicit_euler}) {
      Settings settings = bend_and_twist(33, precision);
      settings.solver.integrator = integrator;
      const Results best = run(kernel::best_instruction_set(), settings, rest, 220, 0.02 * r, 0.1);
      EXPECT_GT(best.pruned, 0);
      for (const auto set : test::instruction_sets())
        EXPECT_TRUE(run(set, settings, rest, 220, 0.02 * r, 0.1) == best) << kernel::name_of(set);
    }
}

TEST(SameBits, OfAllInstructionSetsForDisorderAndCoincidence) {
  const Points lattice = test::fcc_box(7, 7, 9, r);
  for (const Precision precision : test::precisions) {
    const Settings settings = bend_and_twist(9, precision);
    const Body body = test::make_body(settings, lattice);
    Particles particles = test::shaken(lattice, body.material, 1.5 * r, 0.1);
    for (std::size_t i = 1; i < particles.size(); i += 5)
      particles.set_position(i, particles.position(i - 1));
    std::vector<Results> results;
    for (const auto set : test::instruction_sets()) {
      Simulation simulation = test::simulation_with(set, settings, lattice, particles,
                                                    test::step_of(settings, body, 0.1));
      while (simulation.steps() < 60) simulation.step();
      results.push_back(results_of(simulation));
    }
    for (const Results& other : results) EXPECT_TRUE(other == results.front());
  }
}

TEST(SameBits, OfAllInstructionSetsForBodiesThatFillNoWholeBlocks) {
  const Points box = test::fcc_box(7, 7, 25, r);
  for (const Precision precision : test::precisions)
    for (const std::size_t size : {1, 2, 7, 8, 9, 15, 16, 17, 31, 33, 255, 257, 511, 513}) {
      const Settings settings = bend_and_twist(25, precision);
      const Points rest(box.begin(), box.begin() + static_cast<std::ptrdiff_t>(size));
      const Results best = run(kernel::best_instruction_set(), settings, rest, 40, 0.1 * r, 0.05);
      for (const auto set : test::instruction_sets())
        EXPECT_TRUE(run(set, settings, rest, 40, 0.1 * r, 0.05) == best)
            << size << " particles, " << kernel::name_of(set);
    }
}

/// So many that eight threads have work in double precision.
Points large_body() { return test::fcc_box(45, 45, 71, r); }

void expect_same_for_threads(Precision precision) {
  const Settings settings = bend_and_twist(71, precision);
  const Points rest = large_body();
  ASSERT_GT(rest.size(), 70000u);
  std::optional<Results> first;
  for (const int threads : {1, 2, 3, 8})
    with_threads(threads, [&] {
      const Results results =
          run(kernel::best_instruction_set(), settings, rest, 16, 0.05 * r, 0.5, 0.25);
      if (!first) first = results;
      EXPECT_GT(results.pruned, 0);
      EXPECT_TRUE(results == *first) << threads << " threads";
    });
}

TEST(SameBits, OfAnyNumberOfThreadsInDoubles) { expect_same_for_threads(Precision::binary64); }

TEST(SameBits, OfAnyNumberOfThreadsInFloats) { expect_same_for_threads(Precision::binary32); }

TEST(SameBits, OfAllInstructionSetsWithSeveralThreads) {
  const Points rest = test::fcc_box(41, 41, 49, r);
  ASSERT_GT(rest.size(), 40000u);
  for (const Precision precision : test::precisions) {
    std::vector<Results> results;
    for (const auto set : test::instruction_sets())
      with_threads(static_cast<int>(results.size()) + 1, [&] {
        results.push_back(run(set, bend_and_twist(49, precision), rest, 2, 0.1 * r, 0.4));
      });
    for (const Results& other : results) EXPECT_TRUE(other == results.front());
  }
}

TEST(SameBits, OfBodiesThatComeInNoOrderAndAreSorted) {
  // Off the lattice: on it they would be brought into order at first.
  Points rest = test::affine(test::fcc_box(15, 15, 33, r), test::turned(Vec3::UnitZ(), 20));
  std::shuffle(rest.begin(), rest.end(), std::mt19937(7));
  for (const Precision precision : test::precisions) {
    const Settings settings = bend_and_twist(33, precision);
    const Results best = run(kernel::best_instruction_set(), settings, rest, 40, 0.02 * r, 0.2);
    EXPECT_GT(best.sorts, 0);
    for (const auto set : test::instruction_sets())
      EXPECT_TRUE(run(set, settings, rest, 40, 0.02 * r, 0.2) == best) << kernel::name_of(set);
    for (const int threads : {1, 3})
      with_threads(threads, [&] {
        EXPECT_TRUE(run(kernel::best_instruction_set(), settings, rest, 40, 0.02 * r, 0.2) == best);
      });
  }
}

TEST(SameBits, HoweverOftenForcesAndEnergiesAreEvaluated) {
  const Points rest = test::fcc_box(7, 7, 33, r);
  for (const Precision precision : test::precisions)
    for (const Integrator integrator :
         {Integrator::symplectic_euler, Integrator::velocity_verlet}) {
      Settings settings = bend_and_twist(33, precision);
      settings.solver.integrator = integrator;
      Simulation quiet = test::make_simulation(settings, rest);
      Simulation asked = test::make_simulation(settings, rest);
      while (quiet.steps() < 100) {
        quiet.step(), asked.step();
        if (asked.steps() % 3 == 0) asked.energies(), asked.particles();
      }
      EXPECT_EQ(state_hash(asked.particles()), state_hash(quiet.particles()));
      EXPECT_EQ(asked.energies().work_of_bones, quiet.energies().work_of_bones);
      EXPECT_EQ(asked.energies().dissipation, quiet.energies().dissipation);
    }
}

}  // namespace sinew::same_bits_test
