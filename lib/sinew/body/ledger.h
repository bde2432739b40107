// SPDX-License-Identifier: GPL-3.0-or-later
// Work of the bones and losses of a body since the start, step by step.
//
//     const StepSums sums = stepper.step(pose);
//     ledger.add_step(sums.power, sums.lost);
#pragma once

#include <cmath>

#include <sinew/core/simulation_state.h>

namespace sinew {

/// Work and losses so far, J.
struct LedgerEntries {
  double work = 0, dissipation = 0;
  double power = 0;    ///< at the beginning of the last step, W
  bool begun = false;  ///< whether there was a step

  bool finite() const {
    return std::isfinite(work) && std::isfinite(dissipation) && std::isfinite(power);
  }
};

/// Calls archive(name, member) for each member, to write or to read it.
template <class Archive>
void serialize(Archive& archive, LedgerEntries& ledger, const std::string& prefix = "") {
  archive(prefix + "work", ledger.work);
  archive(prefix + "lost", ledger.dissipation);
  archive(prefix + "power", ledger.power);
  archive(prefix + "begun", ledger.begun);
}

/// The ledgers of a simulation, as its states have them.
struct Ledgers {
  LedgerEntries of_bones;
  LedgerEntries of_world;    ///< obstacles, fields, muscles and pins
  double held_at_start = 0;  ///< kinetic energy of what pins hold, J

  bool finite() const {
    return of_bones.finite() && of_world.finite() && std::isfinite(held_at_start);
  }
};

/// Name of their part.
inline constexpr std::string_view ledgers_part = "ledgers";

template <class Archive>
void serialize(Archive& archive, Ledgers& ledgers) {
  serialize(archive, ledgers.of_bones, "bones_");
  serialize(archive, ledgers.of_world, "world_");
  archive("held_at_start", ledgers.held_at_start);
}

class EnergyLedger {
 public:
  explicit EnergyLedger(double step) : step_(step), last_(step) {}

  /// Sets the size of the steps that follow, s.
  void set_step(double step) { step_ = step; }

  /// Adds a step that began with this power of the bones and this loss (W); trapezoidal rule for
  /// the power.
  void add_step(double power, double lost) {
    now_.work = work_until(power);
    now_.power = power;
    now_.begun = true;
    now_.dissipation += step_ * lost;
    last_ = step_;
  }

  /// Adds work and losses of a moment, J.
  void add(double work, double lost) {
    now_.work += work;
    now_.dissipation += lost;
  }

  /// Until a moment with that power, J.
  double work_until(double power) const {
    return now_.begun ? now_.work + last_ * (now_.power + power) / 2 : now_.work;
  }
  /// Including half of the step that begins with that loss, for the moment of the positions, J.
  double dissipation_until(double lost) const { return now_.dissipation + step_ * lost / 2; }

  const LedgerEntries& entries() const { return now_; }
  /// `last`: the size of the step that was added last, s.
  void restore(const LedgerEntries& entries, double last) {
    now_ = entries;
    step_ = last_ = last;
  }

 private:
  double step_, last_;  ///< s, of the next step and of the one before
  LedgerEntries now_;
};

}  // namespace sinew
