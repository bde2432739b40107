// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/frame_guard.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/stepping/simulation.h>
#include <sinew/stepping/stepper.h>

namespace sinew {
namespace {

// At the largest divisor, what is still too fast is slowed instead. Divisors are held for all
// frames up to the last one that a state lists.
constexpr int max_divisor = 16, max_frame = 1 << 20;
// What snaps out between two parts moves half a radius at half the limit of the step; what moves
// farther may pass through its neighbors.
constexpr double max_radii_of_snap = 1;
// Fraction of the energy turned over: snaps of squeezed particles leave 0.4 to 8 %.
constexpr double max_residual = 0.2;
// Below the limit, since damping has less to slow then.
constexpr double limited_to = 0.8 * max_radii_per_step;
// What is slowed pushes its neighbors less, and is pushed by others: a few rounds settle a snap,
// and a tenth of the particles in a frame is no snap but the body itself.
constexpr int max_limits_in_step = 10;
constexpr double max_limited = 0.1;  // fraction of the particles, in a frame

}  // namespace

StepPlan plan_with(const StepPlan& whole, const GuardState& state) {
  std::vector<int> divisors;
  for (std::size_t k = 0; k + 1 < state.divided.size(); k += 2) {
    const int frame = state.divided[k], by = state.divided[k + 1];
    if (frame <= static_cast<int>(divisors.size()) || frame > max_frame || by < 1 ||
        by > max_divisor)
      throw not_a_state("frame " + std::to_string(frame) + " has steps of 1/" + std::to_string(by));
    divisors.resize(static_cast<std::size_t>(frame), 1);
    divisors.back() = by;
  }
  return divisors.empty() ? whole : whole.divided(divisors);
}

FrameGuard::FrameGuard(Simulation& simulation, StepPlan plan)
    : simulation_(simulation), steps_(simulation), whole_(std::move(plan)), plan_(whole_) {}

void FrameGuard::begin(int frame) {
  frame_ = frame;
  const int carried = state_.divisor / 2;
  state_.divisor = 1;
  steps_.begin_counting();
  be_lenient(false);
  SimulationState begun = simulation_.save();
  put_part(begun, guard_part, state_);
  begun_ = std::make_shared<const SimulationState>(std::move(begun));
  if (carried > 1) divide(carried);
}

bool FrameGuard::is_there() const { return simulation_.steps() == plan_.steps_until(frame_); }

void FrameGuard::step() {
  if (steps_.try_advance(1)) {
    limits_in_step_ = 0;
    if (is_there() && state_.lenient) check_balance();
    return;
  }
  const auto& all = simulation_.offenders();
  const bool finite =
      std::all_of(all.begin(), all.end(), [](const Offender& one) { return one.finite; });
  const bool snaps = finite && std::all_of(all.begin(), all.end(), [&](const Offender& one) {
                       return one.moved < max_radii_of_snap * simulation_.body().material.pair.r;
                     });
  if (state_.divisor == 1 && steps_.is_misjudged()) steps_.fail();
  if (state_.divisor < max_divisor) {
    if (!snaps || state_.lenient) return take_anew({frame_, 2 * state_.divisor, 0, true});
    const Balanced now = balance();
    state_.residual = now.residual, state_.turnover = now.turnover - energy_of_offenders();
    be_lenient(true);
  } else if (finite) {
    limit_speeds();
  } else {
    steps_.fail();
  }
}

void FrameGuard::be_lenient(bool lenient) {
  state_.lenient = lenient;
  steps_.allow_moves(lenient ? max_radii_of_snap : max_radii_per_step);
}

void FrameGuard::divide(int by) {
  auto& divided = state_.divided;
  if (divided.size() >= 2 && divided.end()[-2] == frame_) divided.resize(divided.size() - 2);
  divided.insert(divided.end(), {frame_, by});
  state_.divisor = by;
  plan_ = plan_with(whole_, state_);
  steps_.go_on_by(plan_);
}

void FrameGuard::take_anew(const Retake& why) {
  simulation_.restore(*begun_);
  state_ = guard_in(*begun_);
  be_lenient(false);
  divide(why.divisor);
  if (on_retake) on_retake(why);
}

FrameGuard::Balanced FrameGuard::balance() {
  const Energies now = simulation_.energies();
  return {now.balance(), now.dissipation + std::abs(now.work())};
}

/// Energy of their motion relative to their bones, in the step that failed, J.
double FrameGuard::energy_of_offenders() const {
  double energy = 0;
  for (const Offender& one : simulation_.offenders())
    energy += simulation_.body().material.mass / 2 * one.moved * one.moved;
  return energy / (simulation_.stepping().step * simulation_.stepping().step);
}

void FrameGuard::check_balance() {
  const Balanced now = balance();
  const double residual =
      std::abs(now.residual - state_.residual) / std::max(1e-300, now.turnover - state_.turnover);
  if (residual > max_residual) take_anew({frame_, 2 * state_.divisor, residual, false});
}

void FrameGuard::limit_speeds() {
  if (++limits_in_step_ > max_limits_in_step || steps_.limit_offenders(limited_to) == 0)
    steps_.fail();
  const auto& times = simulation_.limited().in_frame;
  const auto concerned = std::count_if(times.begin(), times.end(), [](int of) { return of > 0; });
  if (static_cast<double>(concerned) > max_limited * static_cast<double>(times.size()))
    steps_.fail();
}

SimulationState FrameGuard::save() const {
  SimulationState state = simulation_.save();
  put_part(state, guard_part, state_);
  if (begun_ && begun_->steps != state.steps) state.begun = begun_;
  return state;
}

void FrameGuard::restore(const SimulationState& state, int frame) {
  const GuardState saved = guard_in(state);
  if (saved.divisor < 1 || saved.divisor > max_divisor)
    throw not_a_state("its steps are divided by " + std::to_string(saved.divisor));
  frame_ = frame;
  state_ = saved;
  plan_ = plan_with(whole_, state_);
  steps_.go_on_by(plan_);
  simulation_.restore(state);
  steps_.go_on_by(plan_);
  be_lenient(state_.lenient);
  begun_ = state.begun ? state.begun : std::make_shared<const SimulationState>(state);
}

}  // namespace sinew
