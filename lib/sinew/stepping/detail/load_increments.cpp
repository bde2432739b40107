// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/detail/load_increments.h>

#include <utility>

#include <sinew/body/step_plan.h>

namespace sinew {
namespace {

using enum Relaxation::Outcome;

constexpr std::int64_t max_corrections = 25;
// Part of an increment within which what acts on a body changes evenly.
constexpr double small_part = 1e-6;

/// Steps of the stepper's own kind, or Newton's where they may be.
LoadSteps as_applies(LoadSteps steps, const Body& body, const Stepping& stepping) {
  if (steps.solver != StaticSolver::relaxation && !why_not_newton(body, stepping).empty())
    steps.solver = StaticSolver::relaxation;
  return steps;
}

}  // namespace

LoadIncrements::LoadIncrements(const Body& body, LoadSteps steps, Stepper& stepper,
                               const Stepping& stepping, const Particles& particles,
                               MomentAt moment_at)
    : relaxation_(as_applies(std::move(steps), body, stepping),
                  relaxation_of(body, stepper, stepping.step)),
      near_(neighbors_of(body)),
      strain_(body, *near_),
      moment_at_(std::move(moment_at)) {
  particles_.radius = particles.radius;
  particles_.mass = particles.mass;
  particles_.id = particles.id;
  if (relaxation_.is_direct())
    newton_ = std::make_unique<Newton>(body, *near_, particles, stepping.gravity);
  near_.reset();
  begin(stepper);
}

Points LoadIncrements::positions(Stepper& stepper) {
  stepper.read(moment(), particles_);
  return positions_by_id(particles_);
}

void LoadIncrements::begin(Stepper& stepper) {
  strain_.begin(positions(stepper));
  begun_.reset();
  SimulationState state;
  stepper.save(state);
  state.steps = steps_;
  put_part(state, rest_part, relaxation_.state());
  begun_ = std::make_shared<const SimulationState>(std::move(state));
}

Relaxation::Outcome LoadIncrements::iterate(Stepper& stepper, std::int64_t steps,
                                            std::vector<Offender>& offenders) {
  steps_ = steps;
  relaxation_.begin_iteration();
  return relaxation_.is_direct() ? solve(stepper) : relax(stepper, offenders);
}

Relaxation::Outcome LoadIncrements::relax(Stepper& stepper, std::vector<Offender>& offenders) {
  const auto outcome = relaxation_.iterate(stepper, moment(), offenders);
  if (outcome == shortened) stepper.set_step(relaxation_.step());
  if (outcome == moved) {
    if (relaxation_.strain_is_due() && is_given_up(stepper, strain_while_moving)) return moved;
    if (relaxation_.is_stalled()) try_otherwise(stepper);
  }
  if (outcome == at_rest && !is_given_up(stepper, 1)) accept(stepper);
  return outcome;
}

void LoadIncrements::accept(Stepper& stepper) {
  relaxation_.accept(strain_.since(positions(stepper)));
  begin(stepper);
}

/// Returns to where the present increment of a load began, to try a shorter one, where it strains
/// the body more than so many times what it may.
bool LoadIncrements::is_given_up(Stepper& stepper, double times) {
  IncrementStrain found = strain_.since(positions(stepper));
  found.strain /= times;
  if (times > 1) found.inverted = 0;  // it may come back
  if (!relaxation_.is_too_large(found, strain_.inverted_at_begin())) return false;
  go_back(stepper, relaxation_.shorter(relaxation_in(*begun_), found.strain));
  return true;
}

void LoadIncrements::go_back(Stepper& stepper, const RelaxationState& to) {
  SimulationState there = *begun_;
  there.steps = steps_;
  relaxation_.restore(to);
  stepper.set_step(relaxation_.step());
  stepper.restore(there);
}

/// Starts again where the increment began: half of it, or without Newton's method.
void LoadIncrements::try_otherwise(Stepper& stepper) {
  go_back(stepper, relaxation_.otherwise(relaxation_in(*begun_)));
}

// Newton's method.

/// Where the load leads by the tangent at its beginning, as far as an increment may go.
bool LoadIncrements::predict(Stepper& stepper) {
  const double from = relaxation_.begin_time(), to = relaxation_.time();
  const auto found = newton_->predict(stepper, moment_at_(from),
                                      moment_at_(from + small_part * (to - from)), small_part);
  if (!found) return false;
  stepper.place(found->positions, Stepper::Move::far);
  const IncrementStrain strained = strain_.since(positions(stepper));  // held ones at its end
  if (relaxation_.is_too_large(strained, strain_.inverted_at_begin())) {
    go_back(stepper, relaxation_.shorter(relaxation_in(*begun_), strained.strain));
    return true;
  }
  if (const double part = max_strain_of_increment / strained.strain; part < 1) {
    Points nearer = newton_->positions();
    for (std::size_t k = 0; k < nearer.size(); ++k)
      nearer[k] += part * (found->positions[k] - nearer[k]);
    stepper.place(nearer, Stepper::Move::far);
  }
  relaxation_.count_solution(found->negative);
  return true;
}

/// Newton's method has come to rest: by shorter increments where the body has become unstable,
/// until these tell where; then it stays on its way, if that is short.
void LoadIncrements::settle(Stepper& stepper) {
  if (relaxation_.has_become_unstable()) return try_otherwise(stepper);
  if (relaxation_.state().negative > 0) {
    relaxation_.found_at_rest(newton_->negative_pivots(stepper, moment()));
    if (relaxation_.state().negative > 0 &&
        strain_.since(positions(stepper)).strain > max_strain_of_increment)
      return try_otherwise(stepper);
  }
  if (!is_given_up(stepper, 1)) accept(stepper);
}

Relaxation::Outcome LoadIncrements::solve(Stepper& stepper) {
  const RelaxationState& state = relaxation_.state();
  if (state.newton == 0 && state.at_rest > 0) {
    if (!predict(stepper)) try_otherwise(stepper);
    return moved;
  }
  if (relaxation_.take(stepper.try_step(moment(), 1))) {
    stepper.halt();
    settle(stepper);
    return at_rest;
  }
  const auto found =
      state.newton < max_corrections ? newton_->correct(stepper, moment()) : std::nullopt;
  if (!found) {
    try_otherwise(stepper);
    return moved;
  }
  stepper.place(found->positions, Stepper::Move::far);
  relaxation_.count_solution(found->negative);
  return moved;
}

void LoadIncrements::save(SimulationState& state) const {
  put_part(state, rest_part, relaxation_.state());
  state.begun = begun_;
}

void LoadIncrements::restore(Stepper& stepper, const SimulationState& state) {
  const auto go_to = [&](const SimulationState& there) {
    relaxation_.restore(relaxation_in(there));  // what supports hold is where they are then
    stepper.set_step(relaxation_.step());
    stepper.restore(there);
  };
  steps_ = state.steps;
  if (state.begun && state.begun != begun_) {
    go_to(*state.begun);
    begin(stepper);
    begun_ = state.begun;
  }
  go_to(state);
  if (!state.begun) begin(stepper);
}

}  // namespace sinew
