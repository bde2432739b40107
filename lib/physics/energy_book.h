// SPDX-License-Identifier: GPL-3.0-or-later
// What the bones have put in and what was lost since the start, step by step.
#pragma once

namespace sinew {

class EnergyBook {
 public:
  explicit EnergyBook(double step) : step_(step) {}

  /// A step that began with this power of the bones and loss (W): trapezoid of the power.
  void add_step(double power, double lost) {
    work_ = work_until(power);
    power_ = power;
    begun_ = true;
    dissipation_ += step_ * lost;
  }

  /// Up to a moment with that power, J.
  double work_until(double power) const {
    return begun_ ? work_ + step_ * (power_ + power) / 2 : work_;
  }
  /// Half of the step that begins with that loss included, for the moment of the positions, J.
  double dissipation_until(double lost) const { return dissipation_ + step_ * lost / 2; }

 private:
  double step_;
  double work_ = 0, power_ = 0, dissipation_ = 0;
  bool begun_ = false;
};

}  // namespace sinew
