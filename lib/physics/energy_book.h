// SPDX-License-Identifier: GPL-3.0-or-later
// What the bones have put in and what was lost since the start, step by step.
#pragma once

#include "core/simulation_state.h"

namespace sinew {

class EnergyBook {
 public:
  explicit EnergyBook(double step) : step_(step) {}

  /// A step that began with this power of the bones and loss (W): trapezoid of the power.
  void add_step(double power, double lost) {
    now_.work = work_until(power);
    now_.power = power;
    now_.begun = true;
    now_.dissipation += step_ * lost;
  }

  /// Up to a moment with that power, J.
  double work_until(double power) const {
    return now_.begun ? now_.work + step_ * (now_.power + power) / 2 : now_.work;
  }
  /// Half of the step that begins with that loss included, for the moment of the positions, J.
  double dissipation_until(double lost) const { return now_.dissipation + step_ * lost / 2; }

  const BookEntries& entries() const { return now_; }
  void restore(const BookEntries& entries) { now_ = entries; }

 private:
  double step_;
  BookEntries now_;
};

}  // namespace sinew
