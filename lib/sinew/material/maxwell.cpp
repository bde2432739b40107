// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/material/maxwell.h>

#include <sinew/core/simulation_state.h>

namespace sinew {

BondSpring Branches::with(BondSpring spring, std::size_t entry) const {
  double slope = 1, shift = 0;
  for (const One& one : all) {
    slope -= one.modulus_ratio * one.flows / 2;
    shift += one.modulus_ratio * (1 - one.flows / 2) * one.stretch[entry];
  }
  return {spring.length + shift / slope, spring.stiffness * slope};
}

double Branches::energy(const BondSpring& spring, std::size_t entry, double distance) const {
  const double longer = distance - spring.length;
  double squares = 0;
  for (const One& one : all)
    squares += one.modulus_ratio * one.stretch[entry] * (one.stretch[entry] - 2 * longer);
  return spring.stiffness / 2 * squares;
}

double Branches::relax(const BondSpring& spring, std::size_t entry, double distance) {
  double freed = 0;
  for (One& one : all) {
    const double elastic = distance - spring.length - one.stretch[entry];
    one.stretch[entry] += one.flows * elastic;
    freed += one.modulus_ratio * one.flows * (2 - one.flows) * elastic * elastic;
  }
  return spring.stiffness / 2 * freed;
}

MaxwellBranches::MaxwellBranches(const BondStrength& strength, std::size_t of_nearest,
                                 std::size_t of_second) {
  for (std::size_t b = 0; b < strength.branch_count(); ++b) {
    const MaxwellBranch& branch = strength.branches[b];
    clocks_.emplace_back(branch.time);
    nearest.all.push_back({branch.modulus_ratio, 0, std::vector<double>(of_nearest, 0)});
    second.all.push_back({branch.modulus_ratio, 0, std::vector<double>(of_second, 0)});
  }
}

void MaxwellBranches::begin(double step) {
  for (std::size_t b = 0; b < clocks_.size(); ++b)
    nearest.all[b].flows = second.all[b].flows = clocks_[b].flows(step);
}

void MaxwellBranches::advance(double step) {
  for (BranchClock& clock : clocks_) clock.advance(step);
}

void MaxwellBranches::save(SimulationState& state) const {
  state.branch_clocks.clear();
  state.branch_stretches.clear();
  for (const BranchClock& clock : clocks_) state.branch_clocks.push_back(clock.ahead());
  for (const Branches* branches : {&nearest, &second})
    for (const Branches::One& one : branches->all)
      state.branch_stretches.insert(state.branch_stretches.end(), one.stretch.begin(),
                                    one.stretch.end());
}

void MaxwellBranches::restore(const SimulationState& state) {
  check_branches(state, clocks_.size());
  std::size_t entries = 0;
  for (const Branches* branches : {&nearest, &second})
    for (const Branches::One& one : branches->all) entries += one.stretch.size();
  if (state.branch_stretches.size() != entries) throw not_a_state("it has other branches");
  auto from = state.branch_stretches.begin();
  for (Branches* branches : {&nearest, &second})
    for (Branches::One& one : branches->all)
      for (double& stretch : one.stretch) stretch = *from++;
  for (std::size_t b = 0; b < clocks_.size(); ++b)
    clocks_[b] = BranchClock(clocks_[b].time(), state.branch_clocks[b]);
}

}  // namespace sinew
