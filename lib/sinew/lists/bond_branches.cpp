// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/bond_branches.h>

#include <cmath>

#include <sinew/core/simulation_state.h>

namespace sinew {

template <class Real>
BondBranches<Real>::BondBranches(const BondStrength& strength, std::size_t entries) {
  for (std::size_t b = 0; b < strength.branch_count(); ++b)
    all_.push_back({strength.branches[b], BranchClock(strength.branches[b].time),
                    std::vector<Real>(entries * kernel::Traits<Real>::block, 0)});
}

template <class Real>
void BondBranches<Real>::put_into(kernel::Bonds<Real>& bonds, double step) {
  double slope = 1;
  for (One& one : all_) {
    const double flows = one.clock.flows(step);
    slope -= one.branch.modulus_ratio * flows / 2;
    bonds.branches_flow = bonds.branches_flow || flows > 0;
    bonds.branch[bonds.branches++] = {one.stretch.data(),
                                      static_cast<Real>(one.branch.modulus_ratio),
                                      static_cast<Real>(flows), 0};
  }
  for (std::size_t b = 0; b < all_.size(); ++b) {
    const double flows = all_[b].clock.flows(step);
    bonds.branch[b].weight =
        static_cast<Real>(all_[b].branch.modulus_ratio * (1 - flows / 2) / slope);
  }
  bonds.slope = static_cast<Real>(slope);
}

template <class Real>
void BondBranches<Real>::advance(double step) {
  for (One& one : all_) one.clock.advance(step);
}

template <class Real>
void BondBranches<Real>::scale(double factor) {
  for (One& one : all_)
    for (Real& stretch : one.stretch) stretch = static_cast<Real>(stretch * factor);
}

template <class Real>
double BondBranches<Real>::shift(std::size_t place) const {
  double sum = 0;
  for (const One& one : all_)
    sum += one.branch.modulus_ratio * static_cast<double>(one.stretch[place]);
  return sum;
}

template <class Real>
void BondBranches<Real>::save(std::span<const kernel::BondEntry> entries,
                              SimulationState& state) const {
  SavedBranches saved;
  for (const One& one : all_) {
    saved.clocks.push_back(one.clock.ahead());
    for_each_whole<kernel::Traits<Real>::block>(entries, [&](std::size_t place) {
      saved.stretches.push_back(static_cast<double>(one.stretch[place]));
    });
  }
  put_branches(state, std::move(saved));
}

template <class Real>
void BondBranches<Real>::restore(std::span<const kernel::BondEntry> entries,
                                 const SimulationState& state) {
  const SavedBranches saved = saved_branches(state, all_.size());
  std::size_t next = 0;
  for (std::size_t b = 0; b < all_.size(); ++b) {
    all_[b].clock = BranchClock(all_[b].branch.time, saved.clocks[b]);
    for_each_whole<kernel::Traits<Real>::block>(entries, [&](std::size_t place) {
      if (next == saved.stretches.size()) throw not_a_state("it has other branches");
      all_[b].stretch[place] = static_cast<Real>(saved.stretches[next++]);
    });
  }
  if (next != saved.stretches.size()) throw not_a_state("it has other branches");
}

template class BondBranches<double>;
template class BondBranches<float>;

}  // namespace sinew
