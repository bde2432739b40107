// SPDX-License-Identifier: GPL-3.0-or-later
// Bonds of a generalized Maxwell solid (a Prony series): beside a bond's spring, of the long-term
// stiffness k (1 - sum g), branches of a spring g k and a dashpot in series, of relaxation time
// tau. The dashpot's stretch q follows that of the bond, dq/dt = (e - q) / tau with e = d - l, and
// the bond pulls with k (e - sum g q): k at once, k (1 - sum g) in the end.
//
// At certain moments q moves to e by the fraction a = 1 - exp(-t / tau), t the time around that
// moment: exact for a bond of constant length, second order in time otherwise. These moments are
// steps, or as many steps apart as fit a 256th of tau: in single precision q could not follow in
// smaller parts. The force at that moment is the mean of before and after; what is lost there is
// the difference of the energies stored, k/2 g a (2 - a) (e - q)^2.
//
//     BranchClock clock(branch.time);
//     const double flows = clock.flows(step);    // at the moment at which a step begins
//     clock.advance(step);                       // once it was made
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <sinew/core/simulation_state.h>
#include <sinew/material/material.h>
#include <sinew/material/pair_force.h>

namespace sinew {

class BranchClock {
 public:
  explicit BranchClock(double time, double ahead = 0) : time_(time), ahead_(ahead) {}

  /// The fraction of its spring's stretch that passes to the dashpot as a step (s) begins; often 0.
  double flows(double step) const { return -std::expm1(-due(step) / time_); }
  void advance(double step) { ahead_ += due(step) - step; }
  double time() const { return time_; }  ///< tau, s
  /// How far the branch's state is ahead of the next step, s; negative behind it.
  double ahead() const { return ahead_; }

 private:
  double due(double step) const {
    const double part = std::max(step, time_ / 256);
    return ahead_ <= (step - part) / 2 ? part / 2 - ahead_ : 0;
  }

  double time_, ahead_;  ///< s
};

/// The branches of some bonds.
struct Branches {
  struct One {
    double modulus_ratio = 0;  ///< fraction of a bond's stiffness
    double flows = 0;          ///< fraction of its spring's stretch that passes to the dashpot now
    std::vector<double> stretch;  ///< stretch of its dashpot, by entry of the bonds, m
  };
  std::vector<One> all;

  /// A spring that pulls as the bond does with them, while they relax.
  BondSpring with(BondSpring spring, std::size_t entry) const;
  /// What they store, beside the spring, at a distance, J.
  double energy(const BondSpring& spring, std::size_t entry, double distance) const;
  /// Lets those of a bond relax at a distance; returns the energy lost, J.
  double relax(const BondSpring& spring, std::size_t entry, double distance);
};

/// Branches of the bonds of a solid.
class MaxwellBranches {
 public:
  MaxwellBranches(const BondStrength& strength, std::size_t nearest, std::size_t second);

  void begin(double step);    ///< begins a step of that size, s
  void advance(double step);  ///< counts that step as made

  /// Throws bad input where the state has others.
  void restore(const SimulationState& state);
  void save(SimulationState& state) const;

  Branches nearest, second;

 private:
  std::vector<BranchClock> clocks_;
};

/// Branches of bonds in a state.
struct SavedBranches {
  std::vector<double> clocks;     ///< how far each is ahead in the end, s
  std::vector<double> stretches;  ///< dashpots of each branch, by bond, in a stepper's lengths
};

void put_branches(SimulationState& state, SavedBranches branches);
/// Throws bad input unless the state has so many branches of bonds, all finite.
SavedBranches saved_branches(const SimulationState& state, std::size_t branches);

}  // namespace sinew
