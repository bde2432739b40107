// SPDX-License-Identifier: GPL-3.0-or-later
// The branches of bonds (see material/maxwell.h) in the kernel's layout.
//
//     BondBranches<Real> branches(strength, entries);
//     branches.put_into(step.bonds, step_size);
//     branches.advance(step_size);                     // once the step was made
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <sinew/core/simulation_state.h>
#include <sinew/kernel/kernel.h>
#include <sinew/material/material.h>
#include <sinew/material/maxwell.h>

namespace sinew {

/// Calls visit(place) for the lanes of all entries that are whole.
template <std::size_t block, class Visit>
void for_each_whole(std::span<const kernel::BondEntry> entries, Visit&& visit) {
  for (std::size_t e = 0; e < entries.size(); ++e)
    for (std::size_t lane = 0; lane < block; ++lane)
      if ((entries[e].lanes >> lane & 1) != 0) visit(e * block + lane);
}

template <class Real>
class BondBranches {
 public:
  BondBranches() = default;  ///< none
  BondBranches(const BondStrength& strength, std::size_t entries);

  bool empty() const { return all_.empty(); }
  /// For a step of that size (s).
  void put_into(kernel::Bonds<Real>& bonds, double step);
  void advance(double step);
  void scale(double factor);  ///< all lengths
  /// Returns the shift of the length at which a bond, by its place, pulls nothing.
  double shift(std::size_t place) const;

  /// Saves the whole lanes of the entries.
  void save(std::span<const kernel::BondEntry> entries, SimulationState& state) const;
  /// Throws bad input where the state has others.
  void restore(std::span<const kernel::BondEntry> entries, const SimulationState& state);

 private:
  struct One {
    MaxwellBranch branch;
    BranchClock clock;
    std::vector<Real> stretch;  ///< entries x block
  };

  std::vector<One> all_;
};

}  // namespace sinew
