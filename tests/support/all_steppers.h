// SPDX-License-Identifier: GPL-3.0-or-later
// The steppers side by side: lists in both precisions and with every instruction set, and the cells
// that serve as reference.
#pragma once

#include <gtest/gtest.h>
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <sinew/core/local_origin.h>
#include <sinew/core/triangles.h>
#include <sinew/scene/prepare.h>
#include <sinew/scene/rig.h>

#include "support/world.h"

namespace sinew::test {

inline std::vector<kernel::InstructionSet> instruction_sets() {
  std::vector<kernel::InstructionSet> sets;
  for (const auto set : {kernel::InstructionSet::plain, kernel::InstructionSet::avx2,
                         kernel::InstructionSet::avx512})
    if (kernel::has(set)) sets.push_back(set);
  return sets;
}

inline constexpr Precision precisions[] = {Precision::binary64, Precision::binary32};

inline Settings in(Precision precision, Settings settings) {
  settings.solver.precision = precision;
  return settings;
}

inline Settings with_cells(Settings settings) {
  settings.solver.neighbor_search = NeighborSearch::cells;
  return settings;
}

/// The step that is `factor` of the limit, s.
inline double step_of(const Settings& settings, const Body& body, double factor = 0.5) {
  return factor * step_limit(settings.solver.integrator, body.material, body.springs);
}

/// The settings' simulation with the kernel of one instruction set.
inline Simulation simulation_with(kernel::InstructionSet set, const Settings& settings,
                                  const Points& rest, const Particles& particles, double step) {
  const Body body = make_body(settings, rest);
  return Simulation(body, motion_of(settings, body.skeleton), particles,
                    stepping_of(settings.solver, step), set);
}

inline double largest_distance(const Particles& a, const Particles& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, (a.position(i) - b.position(i)).norm());
  return most;
}

inline double largest_difference_of_velocity(const Particles& a, const Particles& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, (a.velocity(i) - b.velocity(i)).norm());
  return most;
}

/// The forces that cells find at the present positions.
inline Forces by_cells(Simulation& simulation, double longer = 0) {
  Material material = simulation.body().material;
  material.pair.b *= 1 + longer;
  Forces forces;
  pair_forces(simulation.particles(), material, forces);
  return forces;
}

/// Bound on what rounding of the places that a body far from the origin tells, but has not, changes
/// in the forces of twelve neighbors, whose slope is 4 k1 r at most; 0 near it.
inline double force_of_rounding(const Points& places, const PairForce& pair) {
  const Box box = bounds(places);
  if (local_origin(box).isZero(0)) return 0;
  const double ulp = std::numeric_limits<double>::epsilon() *
                     box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  return 12 * 4 * pair.k1 * pair.r * ulp;
}

/// The lists' pairs and forces are those that the cells find at the same positions: in double
/// precision the same pairs, and forces to 1e-12 k1 r^2.
inline void expect_pairs_of_cells(Simulation& simulation) {
  const PairForce& pair = simulation.body().material.pair;
  const Forces found = simulation.forces(), expected = by_cells(simulation);
  const double tolerance = 1e-12 * pair.k1 * pair.r * pair.r +
                           force_of_rounding(positions_of(simulation.particles()), pair);
  for (std::size_t i = 0; i < expected.pair.size(); ++i) {
    ASSERT_EQ(found.neighbors[i], expected.neighbors[i])
        << "particle " << i << " at " << simulation.time() << " s";
    ASSERT_LT((found.pair[i] - expected.pair[i]).norm(), tolerance) << "particle " << i;
  }
}

/// In single precision squared distances are wrong by at most 4 parts of 2^24: by so much may pairs
/// at the range be missed or added, and by so much of k1 d^2 (and of the steeper attraction, k2 (b
/// - a) d, with lambda = 1) may each neighbor's force be wrong.
inline void expect_pairs_of_cells_to_floats(Simulation& simulation) {
  const PairForce& pair = simulation.body().material.pair;
  const Forces found = simulation.forces(), expected = by_cells(simulation);
  const Forces fewest = by_cells(simulation, -3e-7), most = by_cells(simulation, 3e-7);
  const double of_a_partner = 2e-6 * pair.k1 * pair.r * pair.r * std::max(1.0, pair.lambda());
  for (std::size_t i = 0; i < expected.pair.size(); ++i) {
    ASSERT_GE(found.neighbors[i], fewest.neighbors[i])
        << "particle " << i << " at " << simulation.time() << " s";
    ASSERT_LE(found.neighbors[i], most.neighbors[i])
        << "particle " << i << " at " << simulation.time() << " s";
    ASSERT_LT((found.pair[i] - expected.pair[i]).norm(),
              of_a_partner * std::max(1, most.neighbors[i]))
        << "particle " << i;
  }
}

inline void expect_pairs_of_cells(Simulation& simulation, Precision precision) {
  if (precision == Precision::binary64)
    expect_pairs_of_cells(simulation);
  else
    expect_pairs_of_cells_to_floats(simulation);
}

}  // namespace sinew::test
