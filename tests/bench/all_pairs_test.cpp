// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "bench/all_pairs.h"
#include "bench/states.h"

namespace sinew::bench {
namespace {

TEST(AllPairs, StepAsTheSimulationDoes) {
  for (const Condition condition : conditions) {
    const Scene scene = scene_of(condition, 3000);
    const Particles start = settled(scene, condition);
    Particles particles = start;
    Simulation simulation = simulation_of(scene, start, Precision::binary64, NeighborSearch::cells);
    Forces forces;
    for (int step = 0; step < 3; ++step) {
      step_all_pairs(particles, scene.body, simulation.pose(), scene.step, forces);
      simulation.step();
    }
    const Particles& other = simulation.particles();
    for (std::size_t i = 0; i < other.size(); ++i)
      ASSERT_LT((particles.position(other.id[i]) - other.position(i)).norm(), 1e-12)
          << name_of(condition);
  }
}

}  // namespace
}  // namespace sinew::bench
