// SPDX-License-Identifier: GPL-3.0-or-later
// A simulation whose steps are iterations towards rest.
#include <limits>
#include <utility>
#include <variant>

#include <sinew/core/error.h>
#include <sinew/stepping/simulation.h>

namespace sinew {
namespace {

/// What rounding leaves of the forces on all particles, N: in units of positions.
double noise_of(const Body& body, double unit) {
  constexpr double each = 10;  // of a particle's bonds together, measured at rest
  double relative = body.stiffness.empty() ? static_cast<double>(body.rest.size()) : 0;
  for (const double stiffness : body.stiffness) relative += stiffness;
  return each * relative * body.material.stiffness() * unit;
}

}  // namespace

void Simulation::relax(LoadSteps steps) {
  const SimulationState state = save();
  if (std::holds_alternative<CellStepper>(stepper_) || body_->grouping)
    throw bad_input("the reference stepper and groups relax nothing",
                    "search neighbors by lists, and leave all particles free");
  const double extent = bounds(body_->rest).diagonal().norm();
  const double unit = std::holds_alternative<MovingInSingle>(state.moving)
                          ? state.whole_numbers.length
                          : extent * std::numeric_limits<double>::epsilon();
  relaxation_.emplace(
      std::move(steps),
      Relaxation::Iteration{stepping_.step, noise_of(*body_, unit), body_->material.pair.r});
}

/// What relaxes stands still, and so do its bones at each moment.
const Pose& Simulation::pose_of_stepper() const {
  if (!relaxation_) return pose();
  still_ = pose();
  for (BonePose& bone : still_) {
    bone.velocity = bone.angular_velocity = Vec3::Zero();
    bone.stretch_rate = 0;
  }
  return still_;
}

void Simulation::halt() {
  std::visit(
      [](auto& stepper) {
        if constexpr (requires { stepper.halt(); }) stepper.halt();
      },
      stepper_);
}

void Simulation::relax_once() {
  relaxation_->begin_iteration();
  const Pose& now = pose_of_stepper();
  set_time();
  StepSums sums;
  bool at_rest = false;
  const auto iterate = [&](auto& stepper) {
    if constexpr (requires { stepper.halt(); }) {
      sums = stepper.try_step(now, relaxation_->keep());
      if (sums.failure) return;
      at_rest = relaxation_->take(sums);
      if (at_rest) return;
      stepper.accept();
      ++steps_;
    }
  };
  std::visit(iterate, stepper_);
  if (sums.failure) {
    offenders_ = std::move(sums.failure->all);
    halt();
    if (!relaxation_->shorten()) fail();
    set_step(relaxation_->step());
  }
  if (at_rest) halt();
}

}  // namespace sinew
