// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/guarded_steps.h>

#include <algorithm>
#include <utility>

#include <sinew/stepping/detail/simulation_parts.h>
#include <sinew/stepping/detail/speed_limits.h>

namespace sinew {
namespace {

bool moved_less(const Offender& a, const Offender& b) {
  return a.finite != b.finite ? a.finite : a.moved < b.moved;
}

}  // namespace

const Offender& GuardedSteps::worst_offender() const {
  const std::vector<Offender>& all = simulation_.offenders();
  return *std::max_element(all.begin(), all.end(), moved_less);
}

FailedStep GuardedSteps::failed() {
  simulation_.evaluate();
  const Simulation::Impl& of = *simulation_.its_;
  return {*of.body,
          simulation_.pose(),
          simulation_.time(),
          simulation_.particles(),
          of.forces,
          of.stepping,
          of.steps};
}

void GuardedSteps::fail() {
  const Offender worst = worst_offender();
  throw unstable(failed(), worst.particle, worst.finite);
}

bool GuardedSteps::is_misjudged() { return is_of_all_steps(failed(), worst_offender().particle); }

void GuardedSteps::go_on_by(StepPlan plan) { simulation_.its_->plan = std::move(plan); }

void GuardedSteps::allow_moves(double radii) { simulation_.its_->stepper->allow_moves(radii); }

std::size_t GuardedSteps::limit_offenders(double radii) {
  Simulation::Impl& of = *simulation_.its_;
  const double before = simulation_.energies().stored();
  const SpeedChange change = slowed(*of.body, simulation_.pose(), simulation_.particles(),
                                    of.forces, of.stepping, of.offenders, radii);
  if (change.particles.empty()) return 0;
  simulation_.add_to_velocities(1, [&](std::size_t i) { return change.gain[i]; });
  of.evaluated = false;
  const double lost = before + change.work - simulation_.energies().stored();
  of.ledger.add(change.work, lost);
  LimitedSpeeds& limited = of.limited;
  limited.in_frame.resize(change.gain.size());
  for (const std::size_t i : change.particles) ++limited.in_frame[i];
  limited.times += static_cast<std::int64_t>(change.particles.size());
  limited.energy += lost;
  limited.impulse += change.impulse;
  return change.particles.size();
}

void GuardedSteps::begin_counting() { simulation_.its_->limited.in_frame.clear(); }

}  // namespace sinew
