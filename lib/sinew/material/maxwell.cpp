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

void put_branches(SimulationState& state, SavedBranches branches) {
  put_column(state, "branches", "clocks", std::move(branches.clocks));
  put_column(state, "branches", "stretches", std::move(branches.stretches));
}

SavedBranches saved_branches(const SimulationState& state, std::size_t branches) {
  SavedBranches saved{column_of<double>(state, "branches", "clocks"),
                      column_of<double>(state, "branches", "stretches")};
  if (saved.clocks.size() != branches)
    throw not_a_state("its bonds have " + std::to_string(saved.clocks.size()) + " branches, not " +
                      std::to_string(branches));
  if (!all_finite(saved.clocks) || !all_finite(saved.stretches))
    throw not_a_state("a branch of a bond has no length");
  return saved;
}

void MaxwellBranches::save(SimulationState& state) const {
  SavedBranches saved;
  for (const BranchClock& clock : clocks_) saved.clocks.push_back(clock.ahead());
  for (const Branches* branches : {&nearest, &second})
    for (const Branches::One& one : branches->all)
      saved.stretches.insert(saved.stretches.end(), one.stretch.begin(), one.stretch.end());
  put_branches(state, std::move(saved));
}

void MaxwellBranches::restore(const SimulationState& state) {
  const SavedBranches saved = saved_branches(state, clocks_.size());
  std::size_t entries = 0;
  for (const Branches* branches : {&nearest, &second})
    for (const Branches::One& one : branches->all) entries += one.stretch.size();
  if (saved.stretches.size() != entries) throw not_a_state("it has other branches");
  auto from = saved.stretches.begin();
  for (Branches* branches : {&nearest, &second})
    for (Branches::One& one : branches->all)
      for (double& stretch : one.stretch) stretch = *from++;
  for (std::size_t b = 0; b < clocks_.size(); ++b)
    clocks_[b] = BranchClock(clocks_[b].time(), saved.clocks[b]);
}

}  // namespace sinew
