// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/equilibrium.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <sinew/core/capabilities.h>
#include <sinew/core/error.h>
#include <sinew/core/simulation_state.h>
#include <sinew/core/text.h>
#include <sinew/stepping/stepper.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

constexpr double shortest = 1.0 / 64;  // fraction of the step, before a body counts as unstable
// Fraction of the shear beyond yield that flows in an iteration.
constexpr double flow_fraction = 0.1;
// Increments of the way from one moment to the next, in parts of it.
constexpr double shortest_increment = 1.0 / 16;
constexpr double longer_by = 2, shorter_by = 0.25;  // at most
constexpr double margin = 0.8;        // fraction of the strain that an increment may have
constexpr double near_rounding = 20;  // times the noise, which is an estimate
constexpr double at_rounding = 3;     // times the noise: forces that are nothing else
// Times the noise: forces of supports and bones where nothing loads a body, as that of a grip which
// carries it along.
constexpr double free_of_force = 1e3;
// Between two moments increments only show the way: they end with this residual, or after so many
// times the iterations of their ramp.
constexpr double residual_between = 1e-2;
constexpr int patience_between = 8;
// Iterations without progress after which a residual stalls: slender bodies need a tenth of them
// for any progress.
constexpr double progress = 0.9;
constexpr std::int64_t stalled_after = 20'000;
constexpr const char* against_rounding =
    "make the load or solver.residual larger, move the mesh nearer to the origin, or in single "
    "precision set solver.precision to double";

/// Factor on an increment that strained a body so, for the next one; up to `longest`.
double allowed(double strain, double longest) {
  if (!(strain > 0)) return longest;
  return std::clamp(margin * max_strain_of_increment / strain, shorter_by, longest);
}

ObstacleMotion standing(const ObstacleMotion& motion) {
  if (!motion) return motion;
  return [motion](double time, const Pose& pose) {
    return ObstaclePose{motion(time, pose).frame, Vec3::Zero(), Vec3::Zero()};
  };
}

/// What rounding leaves of the forces on all particles, N: in units of positions.
double noise_of(const Body& body, double unit) {
  constexpr double each = 10;  // noise of a particle's bonds together, measured at rest
  double relative = body.stiffness.empty() ? static_cast<double>(body.rest.size()) : 0;
  for (const double stiffness : body.stiffness) relative += stiffness;
  return each * relative * body.material.stiffness() * unit;
}

}  // namespace

Body undamped(Body body) {
  body.material.damping = 0;
  body.material = long_term(body.material);
  for (BoneSprings& springs : body.springs) springs.damping = 0;
  body.rigid_damping = nullptr;
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
      negligible_(iteration.negligible),
      radius_(iteration.radius) {}

int Relaxation::ramp() const {
  const auto next = static_cast<std::size_t>(now_.at_rest);
  const int whole = next == 0 || next > steps_.ramp.size() ? 1 : steps_.ramp[next - 1];
  const auto part = static_cast<int>(std::ceil(whole * now_.increment));
  return std::max(part, std::min(whole, steps_.min_ramp));
}

bool Relaxation::strain_is_due() const {
  constexpr int rarely = 100;
  return now_.at_rest > 0 && now_.iterations % std::max(ramp(), rarely) == 0;
}

bool Relaxation::is_last_increment() const {
  return now_.at_rest == 0 || now_.reached + now_.increment > 1 - shortest_increment / 2;
}

/// In intervals.
double Relaxation::moment(std::int64_t index) const {
  const std::int64_t last = steps_.count - 1;
  const double whole = static_cast<double>(std::min(index, last));
  return index < last || last < 1 ? whole : whole - 1 + steps_.last;
}

double Relaxation::end() const { return is_last_increment() ? 1 : now_.reached + now_.increment; }

double Relaxation::time_at(double reached) const {
  if (now_.at_rest == 0) return 0;
  const double from = moment(now_.at_rest - 1), length = moment(now_.at_rest) - from;
  return steps_.interval * (from + length * reached);
}

double Relaxation::begin_time() const { return time_at(now_.reached); }

double Relaxation::time() const {
  if (now_.iterations == 0) return begin_time();
  if (is_direct()) return time_at(end());
  const double passed = static_cast<double>(now_.iterations) / ramp();
  return time_at(now_.reached + (end() - now_.reached) * std::min(passed, 1.0));
}

void Relaxation::count_solution(std::int64_t negative) {
  ++now_.newton;
  now_.negative = std::max(now_.negative, negative);
}

bool Relaxation::is_stalled() const {
  return may_shorten() && now_.iterations > now_.best_at + stalled_after;
}

double Relaxation::keep() const {
  const double by = now_.damping * step();
  return (2 - by) / (2 + by);
}

double Relaxation::reference() const { return std::max(now_.largest, now_.applied); }

double Relaxation::residual() const {
  const bool is_rounding =
      now_.unbalanced <= at_rounding * noise_ && reference() < free_of_force * noise_;
  return reference() > noise_ && !is_rounding ? now_.unbalanced / reference() : 0;
}

double Relaxation::tolerance() const {
  return std::max(steps_.residual * reference(), at_rounding * negligible_);
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
  const double residual =
      is_last_increment() ? steps_.residual : std::max(steps_.residual, residual_between);
  const double wanted = residual * reference();
  if (wanted >= noise_) return sums.unbalanced <= wanted;
  const bool is_hidden = steps_.acceptable * reference() < at_rounding * noise_;
  const bool is_free = sums.loaded == 0 && reference() < free_of_force * noise_;
  const bool may_vanish = sums.loaded == 0 && sums.unbalanced > at_rounding * noise_;
  if (is_hidden && !is_free && !may_vanish) refuse_noise();
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
  if ((is_direct() || now_.iterations >= ramp()) && is_at_rest(sums.imbalance)) return true;
  if (!is_direct() && !is_last_increment() &&
      now_.iterations >= std::int64_t{patience_between} * ramp())
    return true;
  if (now_.spent + now_.iterations >= steps_.max_iterations) give_up();
  if (now_.best_at == 0 || now_.iterations <= ramp() || now_.unbalanced < progress * now_.best) {
    now_.best = now_.unbalanced;
    now_.best_at = now_.iterations;
  }
  find_damping(sums.imbalance);
  return false;
}

void Relaxation::accept(const IncrementStrain& found) {
  const bool is_there = is_last_increment();
  now_.largest = reference();
  if (now_.negative > 0) {
    if (now_.unstable == 0 && !buckled_) buckled_ = {begin_time(), time_at(end())};
    ++now_.unstable;
  }
  now_.spent += now_.iterations;
  ++now_.increments;
  if (is_there) {
    last_ = {now_.spent, now_.increments, residual(), found.inverted, now_.unstable, tolerance()};
    ++now_.at_rest;
  }
  now_.reached = is_there ? 0 : now_.reached + now_.increment;
  if (is_there) now_.spent = now_.increments = now_.unstable = 0;
  const double longest = now_.increment * allowed(found.strain, longer_by);
  const double left = 1 - now_.reached;
  now_.increment = left / std::ceil(left / std::min(longest, left));
  now_.iterations = now_.best_at = now_.newton = now_.negative = 0;
  now_.damping = now_.pushed = now_.best = 0;
}

bool Relaxation::may_shorten() const {
  return now_.at_rest > 0 && end() - now_.reached >= 1.5 * shortest_increment;
}

bool Relaxation::has_become_unstable() const {
  return now_.negative > 0 && now_.unstable == 0 && may_shorten();
}

bool Relaxation::is_too_large(const IncrementStrain& found, std::size_t before) const {
  return may_shorten() && (found.strain > max_strain_of_increment || found.inverted > before);
}

RelaxationState Relaxation::shorter(RelaxationState begun, double strain) const {
  begun.spent = now_.spent + now_.iterations;
  begun.increment =
      std::max(shortest_increment, now_.increment * std::min(0.5, allowed(strain, longer_by)));
  return begun;
}

RelaxationState Relaxation::otherwise(RelaxationState begun) const {
  begun.spent = now_.spent + now_.iterations;
  if (may_shorten()) {
    begun.increment = std::max(shortest_increment, now_.increment / 2);
  } else {
    begun.newton = -1;
    begun.unstable = now_.unstable + (now_.negative > 0 ? 1 : 0);
  }
  return begun;
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
                                  three_digits(noise_ / reference()) + "; " + against_rounding);
}

std::string Relaxation::moment_text() const {
  return "load step " + std::to_string(now_.at_rest) + " at " +
         three_digits(moment(now_.at_rest) * steps_.interval) + " s";
}

void Relaxation::give_up() const {
  const bool near_noise = now_.unbalanced < near_rounding * noise_;
  const std::string cure =
      near_noise          ? std::string("rounding may leave no less: ") + against_rounding
      : now_.unstable > 0 ? "the way there is unstable: past a limit point, move supports by keys "
                            "in place of the load"
                          : "make solver.iterations larger and resume, or make output.interval "
                            "shorter";
  throw Error(Exit::unstable, moment_text() + " is not in equilibrium: the residual is " +
                                  three_digits(residual()) + " after " +
                                  std::to_string(now_.spent + now_.iterations) +
                                  " iterations, not " + three_digits(steps_.residual) + "; " +
                                  cure);
}

void Relaxation::restore(const RelaxationState& state) {
  const bool counted = state.at_rest >= 0 && state.at_rest <= steps_.count &&
                       state.iterations >= 0 && state.iterations <= std::numeric_limits<int>::max();
  const bool known = is_computable(state.damping) && is_computable(state.pushed) &&
                     is_computable(state.largest) && is_computable(state.applied) &&
                     is_computable(state.unbalanced) && state.spent >= 0 && state.increments >= 0 &&
                     state.reached >= 0 && state.reached < 1 && state.increment > 0 &&
                     state.increment <= 1 && is_computable(state.best) && state.best_at >= 0 &&
                     state.newton >= -1 && state.negative >= 0 && state.unstable >= 0;
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
  if (body.grouping) refuse_conflicts(Feature::equilibria, {Feature::groups});
  if (!stepper.relaxes()) refuse_conflicts(Feature::equilibria, {Feature::cells});
  SimulationState state;
  stepper.save(state);
  const Box box = bounds(body.rest).translated(-state.fixed_point_units.origin);
  const double coordinate = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  const double fine =
      std::max(coordinate, box.diagonal().norm()) * std::numeric_limits<double>::epsilon();
  const double unit =
      std::holds_alternative<MovingInSingle>(state.moving) ? state.fixed_point_units.length : fine;
  return {step, noise_of(body, unit), noise_of(body, fine), body.material.pair.r};
}

}  // namespace sinew
