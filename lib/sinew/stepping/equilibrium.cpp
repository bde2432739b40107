// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/equilibrium.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/simulation_state.h>
#include <sinew/core/text.h>
#include <sinew/stepping/stepper.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

constexpr double shortest = 1.0 / 64;  // of the step, before a body counts as unstable
// Fraction of the shear beyond yield that flows in an iteration.
constexpr double flow_fraction = 0.1;
constexpr double near_rounding = 20;  // times the noise, which is an estimate
constexpr double at_rounding = 3;     // times the noise: forces that are nothing else

ObstacleMotion standing(const ObstacleMotion& motion) {
  if (!motion) return motion;
  return [motion](double time, const Pose& pose) {
    return ObstaclePose{motion(time, pose).frame, Vec3::Zero(), Vec3::Zero()};
  };
}

/// What rounding leaves of the forces on all particles, N: in units of positions.
double noise_of(const Body& body, double unit) {
  constexpr double each = 10;  // of a particle's bonds together, measured at rest
  double relative = body.stiffness.empty() ? static_cast<double>(body.rest.size()) : 0;
  for (const double stiffness : body.stiffness) relative += stiffness;
  return each * relative * body.material.stiffness() * unit;
}

}  // namespace

Body undamped(Body body) {
  body.material.damping = 0;
  body.material = long_term(body.material);
  for (BoneSprings& springs : body.springs) springs.damping = 0;
  if (!body.world) return body;
  World world = *body.world;
  for (Obstacle& obstacle : world.obstacles) obstacle.motion = standing(obstacle.motion);
  for (Support& support : world.supports) support.motion = standing(support.motion);
  if (world.drag.velocity.isZero(0)) world.drag.rate = 0;
  body.world = std::make_shared<const World>(std::move(world));
  return body;
}

Relaxation::Relaxation(LoadSteps steps, const Iteration& iteration)
    : steps_(std::move(steps)),
      step_(iteration.step),
      noise_(iteration.noise),
      radius_(iteration.radius) {}

int Relaxation::ramp() const {
  const auto next = static_cast<std::size_t>(now_.at_rest);
  return next == 0 || next > steps_.ramp.size() ? 1 : steps_.ramp[next - 1];
}

/// In intervals.
double Relaxation::moment(std::int64_t index) const {
  const std::int64_t last = steps_.count - 1;
  const double whole = static_cast<double>(std::min(index, last));
  return index < last || last < 1 ? whole : whole - 1 + steps_.last;
}

double Relaxation::time() const {
  if (now_.at_rest == 0) return 0;
  const double passed = static_cast<double>(now_.iterations) / ramp();
  const double from = moment(now_.at_rest - 1), length = moment(now_.at_rest) - from;
  return steps_.interval * (from + length * std::min(passed, 1.0));
}

double Relaxation::keep() const {
  const double by = now_.damping * step();
  return (2 - by) / (2 + by);
}

double Relaxation::reference() const { return std::max(now_.largest, now_.applied); }

double Relaxation::residual() const {
  return reference() > noise_ ? now_.unbalanced / reference() : 0;
}

/// The Rayleigh quotient of the last motion, which the change of the accelerations gives.
void Relaxation::find_damping(const Imbalance& sums) {
  const double h = step(), kept = keep();
  if (sums.vv > 0) {
    const double w2 = (now_.pushed - sums.av) / (h * sums.vv);
    now_.damping = 2 * std::sqrt(std::clamp(w2, 0.0, 1 / (h * h)));
  }
  now_.pushed = kept * sums.av + h * (1 + kept) / 2 * sums.aa;
}

/// Bonds that flow go on to do so where forces balance for a moment.
bool Relaxation::is_at_rest(const Imbalance& sums) const {
  const double flowing = step() / flow_fraction * sums.flowing;
  if (flowing > steps_.residual * reference() * radius_) return false;
  if (reference() <= noise_) {
    if (sums.loaded > 0 && sums.unbalanced <= at_rounding * noise_) refuse_noise();
    return sums.unbalanced <= at_rounding * noise_;
  }
  const double wanted = steps_.residual * reference();
  if (wanted >= noise_) return sums.unbalanced <= wanted;
  if (steps_.acceptable * reference() < at_rounding * noise_) refuse_noise();
  return sums.unbalanced <= at_rounding * noise_;
}

bool Relaxation::take(const StepSums& sums) {
  try {
    return judge(sums);
  } catch (const Error&) {
    --now_.iterations;  // this one is not accepted, and made again where the run is resumed
    throw;
  }
}

bool Relaxation::judge(const StepSums& sums) {
  now_.unbalanced = sums.imbalance.unbalanced;
  now_.applied = sums.imbalance.applied;
  if (now_.iterations >= ramp() && is_at_rest(sums.imbalance)) {
    now_.largest = reference();
    last_ = {now_.iterations, residual()};
    ++now_.at_rest;
    now_.iterations = 0;
    now_.damping = now_.pushed = 0;
    return true;
  }
  if (now_.iterations >= steps_.max_iterations) give_up();
  find_damping(sums.imbalance);
  return false;
}

bool Relaxation::shorten() {
  if (now_.shortened <= shortest) return false;
  now_.shortened /= 2;
  now_.damping = now_.pushed = 0;
  return true;
}

/// What rounding leaves may hide forces that nothing answers.
void Relaxation::refuse_noise() const {
  throw Error(Exit::unstable, moment_text() + " cannot be brought to a residual of " +
                                  three_digits(steps_.residual) +
                                  ": rounding hides what is below " +
                                  three_digits(noise_ / reference()) +
                                  "; make the load or solver.residual larger, or in single "
                                  "precision set solver.precision to double");
}

std::string Relaxation::moment_text() const {
  return "load step " + std::to_string(now_.at_rest) + " at " +
         three_digits(moment(now_.at_rest) * steps_.interval) + " s";
}

void Relaxation::give_up() const {
  const bool near_noise = now_.unbalanced < near_rounding * noise_;
  throw Error(Exit::unstable,
              moment_text() + " is not in equilibrium: the residual is " +
                  three_digits(residual()) + " after " + std::to_string(now_.iterations) +
                  " iterations, not " + three_digits(steps_.residual) +
                  (near_noise ? "; rounding may leave no less: make the load or solver.residual "
                                "larger, or in single precision set solver.precision to double"
                              : "; make solver.iterations larger and resume, or make "
                                "output.interval shorter"));
}

void Relaxation::restore(const RelaxationState& state) {
  const bool counted = state.at_rest >= 0 && state.at_rest <= steps_.count &&
                       state.iterations >= 0 && state.iterations <= std::numeric_limits<int>::max();
  const bool known = is_computable(state.damping) && is_computable(state.pushed) &&
                     is_computable(state.largest) && is_computable(state.applied) &&
                     is_computable(state.unbalanced);
  if (!counted || !known || !(state.shortened > 0 && state.shortened <= 1))
    throw not_a_state("its way to rest is none");
  now_ = state;
}

Relaxation::Outcome Relaxation::iterate(Stepper& stepper, const TimedPose& still,
                                        std::vector<Offender>& offenders) {
  StepSums sums = stepper.try_step(still, keep());
  if (sums.failure) {
    offenders = std::move(sums.failure->all);
    stepper.halt();
    return shorten() ? Outcome::shortened : Outcome::failed;
  }
  if (take(sums)) {
    stepper.halt();
    return Outcome::at_rest;
  }
  stepper.accept();
  return Outcome::moved;
}

void stop(Pose& pose) {
  for (BonePose& bone : pose) {
    bone.velocity = bone.angular_velocity = Vec3::Zero();
    bone.stretch_rate = 0;
  }
}

Relaxation::Iteration relaxation_of(const Body& body, Stepper& stepper, double step) {
  if (!stepper.relaxes() || body.grouping)
    throw bad_input("the reference stepper and groups relax nothing",
                    "search neighbors by lists, and leave all particles free");
  SimulationState state;
  stepper.save(state);
  const double extent = bounds(body.rest).diagonal().norm();
  const double unit = std::holds_alternative<MovingInSingle>(state.moving)
                          ? state.fixed_point_units.length
                          : extent * std::numeric_limits<double>::epsilon();
  return {step, noise_of(body, unit), body.material.pair.r};
}

}  // namespace sinew
