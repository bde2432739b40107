// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of a simulation for who tries them again where one fails (frame_guard.h).
#pragma once

#include <cstddef>
#include <cstdint>

#include <sinew/analysis/instability.h>
#include <sinew/body/step_plan.h>
#include <sinew/stepping/simulation.h>

namespace sinew {

class GuardedSteps {
 public:
  explicit GuardedSteps(Simulation& simulation) : simulation_(simulation) {}

  /// Returns false at a step that fails; the particles stay where they were before it.
  bool try_advance(std::int64_t steps) { return simulation_.try_advance(steps); }
  /// Throws because of the worst of the offenders.
  [[noreturn]] void fail();
  /// What the offenders did tells that all steps are too long, or gravity in a wrong unit.
  bool is_misjudged();

  /// Goes on by a plan in which the steps so far are the same.
  void go_on_by(StepPlan plan);
  /// Lets particles move so far in a step, in radii, before it fails.
  void allow_moves(double radii);
  /// Slows the offenders, relative to their bones, so that each will move about that far in the
  /// next step, in radii; returns how many. The loss is part of the dissipation, and the work that
  /// their bones do on them part of the bones'.
  std::size_t limit_offenders(double radii);
  void begin_counting();  ///< starts `in_frame` of the limits anew

 private:
  const Offender& worst_offender() const;
  FailedStep failed();

  Simulation& simulation_;
};

}  // namespace sinew
