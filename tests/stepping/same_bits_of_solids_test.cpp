// SPDX-License-Identifier: GPL-3.0-or-later
// The same bits from every instruction set and any number of threads, of bodies that creep, break
// and fold onto themselves among obstacles, pins, fields and muscles.
#include <sinew/core/parallel.h>

#include "support/all_steppers.h"
#include "support/surroundings.h"

namespace sinew::same_bits_of_solids_test {

using namespace surroundings;

struct Story {
  Settings settings;
  Points rest;
  std::string around;
  double shake;

  Body body() const {
    Body made = test::make_body(settings, rest);
    World world;
    for (const Around& one : all_surroundings())
      if (one.name == around && one.surround) one.surround(rest, made.material, world);
    made.world = std::make_shared<const World>(world);
    return made;
  }
};

Settings folded(Precision precision, int half_planes) {
  Settings settings = test::in(precision, test::box_scene(half_planes));
  settings.material.model = MaterialModel::bonded_volume;
  settings.material.damping_form = DampingForm::central;
  settings.material.yield_strain = 0.05;
  settings.material.creep_rate = 30;
  settings.material.relaxation_shares = {0.2, 0.1};
  settings.material.relaxation_times = {0.002, 0.5};
  settings.material.breaking_strain = 0.1;
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.25, 150)})};
  return settings;
}

struct Results {
  std::uint64_t state;
  std::vector<double> energies;
  std::vector<std::int32_t> broken;
  std::vector<double> reactions;
  std::int64_t listed, pruned;

  bool operator==(const Results&) const = default;
};

Results run(const Story& story, kernel::InstructionSet set, int steps) {
  const Body body = story.body();
  Simulation simulation(
      body, motion_of(story.settings, body.skeleton),
      test::shaken(story.rest, body.material, story.shake, 0.05),
      stepping_of(story.settings.solver, test::step_of(story.settings, body, 0.08)), set);
  while (simulation.steps() < steps) simulation.step();
  const Energies of = simulation.energies();
  Results results{state_hash(simulation.particles()),
                  {of.kinetic, of.pair, of.bone, of.work_of_bones, of.dissipation, of.contact,
                   of.work_of_world},
                  simulation.broken_bonds(),
                  {},
                  simulation.list_counts().listed,
                  simulation.list_counts().pruned};
  for (const auto& all : {simulation.reactions_of_obstacles(), simulation.support_reactions(),
                          simulation.load_reactions()})
    for (const Reaction& on : all)
      for (const double value : {on.force.x(), on.force.y(), on.force.z(), on.moment.x(), on.power})
        results.reactions.push_back(value);
  return results;
}

std::size_t breaks(const Results& results) {
  return static_cast<std::size_t>(std::count_if(results.broken.begin(), results.broken.end(),
                                                [](std::int32_t bonds) { return bonds > 0; }));
}

TEST(SameBitsOfSolids, OfAllInstructionSets) {
  for (const Precision precision : test::precisions)
    for (const std::string around : {"nothing", "all"}) {
      const Story story{folded(precision, 33), test::fcc_box(9, 9, 33, r), around, 0.03 * r};
      const Results best = run(story, kernel::best_instruction_set(), 400);
      EXPECT_GT(breaks(best), 0U) << around;
      for (const auto set : test::instruction_sets())
        EXPECT_TRUE(run(story, set, 400) == best) << kernel::name_of(set) << ", " << around;
    }
}

TEST(SameBitsOfSolids, OfAnyNumberOfThreads) {
  const Points rest = test::fcc_box(41, 41, 61, r);
  ASSERT_GT(rest.size(), 50000U);
  for (const Precision precision : test::precisions) {
    const Story story{folded(precision, 61), rest, "all", 0.1 * r};
    std::optional<Results> first;
    for (const int threads : {1, 2, 3, 8})
      with_threads(threads, [&] {
        const Results results = run(story, kernel::best_instruction_set(), 12);
        if (!first) first = results;
        EXPECT_TRUE(results == *first) << threads << " threads";
      });
    EXPECT_GT(breaks(*first), 0U);
  }
}

}  // namespace sinew::same_bits_of_solids_test
