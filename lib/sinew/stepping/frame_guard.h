// SPDX-License-Identifier: GPL-3.0-or-later
// Steps to one frame after another. A frame in which steps fail is taken anew, from the state at
// its start, with half the step, down to a sixteenth; where that does not help, particles that are
// too fast are slowed.
//
//     FrameGuard guard(simulation, plan);
//     for (int frame = 1; frame <= frames; ++frame)
//       for (guard.begin(frame); !guard.is_there();) guard.step();
//
// A particle that snaps out between two parts of the body that press on it moves over
// max_radii_per_step, though nothing is unstable. Such steps are allowed where the balance of
// energies holds until the end of the frame.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <sinew/body/step_plan.h>
#include <sinew/core/simulation_state.h>
#include <sinew/stepping/guarded_steps.h>

namespace sinew {

/// State of who takes frames anew in which steps fail.
struct GuardState {
  std::vector<std::int32_t> divided = {};  ///< pairs: a frame, by what its steps were divided
  std::int32_t divisor = 1;                ///< divisor of the present frame
  bool lenient = false;                    ///< particles may snap, as long as energies balance
  double residual = 0, turnover = 0;       ///< energies of the balance when that began, J
};

template <class Archive>
void serialize(Archive& archive, GuardState& state) {
  archive("divided", state.divided);
  archive("divisor", state.divisor);
  archive("lenient", state.lenient);
  archive("residual", state.residual);
  archive("turnover", state.turnover);
}

/// Name of its part in states.
inline constexpr std::string_view guard_part = "guard";
inline GuardState guard_in(const SimulationState& state) {
  return part_of<GuardState>(state, guard_part);
}

/// A frame that is taken anew.
struct Retake {
  int frame = 0;
  int divisor = 1;             ///< divisor of its steps, from now on
  double residual = 0;         ///< residual of the balance of energies, over the energy turned over
  bool moved_too_far = false;  ///< a particle, in a step; else the balance did not hold
};

/// The plan with what frames so far were divided by.
StepPlan plan_with(const StepPlan& whole, const GuardState& state);

class FrameGuard {
 public:
  /// `simulation` follows that plan in intervals, one for each frame.
  FrameGuard(Simulation& simulation, StepPlan plan);

  /// Steps lead to that frame from now on. Keeps the present state.
  void begin(int frame);
  bool is_there() const;
  /// Makes a step; the frame may then be at its start again. Throws Error (unstable) as
  /// Simulation::step() does where neither shorter steps nor limits of speed help, and at once
  /// where the scene's step is over the limit of the body at rest.
  void step();

  /// With what frames so far were divided by.
  const StepPlan& plan() const { return plan_; }
  const GuardState& state() const { return state_; }
  /// Is told of each.
  std::function<void(const Retake&)> on_retake = {};

  SimulationState save() const;
  /// Continues from there, within a frame; `frame`: the one that its steps lead to.
  void restore(const SimulationState& state, int frame);

 private:
  /// Sums of energies, J.
  struct Balanced {
    double residual = 0, turnover = 0;
  };

  void divide(int by);
  void take_anew(const Retake& why);
  void be_lenient(bool lenient);
  void limit_speeds();
  void check_balance();
  Balanced balance();
  double energy_of_offenders() const;

  Simulation& simulation_;
  GuardedSteps steps_;
  StepPlan whole_, plan_;
  int frame_ = 0;
  GuardState state_;
  std::shared_ptr<const SimulationState> begun_;
  int limits_in_step_ = 0;
};

}  // namespace sinew
