// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/simulation.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <sinew/body/solid.h>
#include <sinew/core/capabilities.h>
#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/groups/make_grouping.h>
#include <sinew/stepping/detail/cell_stepper.h>
#include <sinew/stepping/detail/list_stepper.h>
#include <sinew/stepping/detail/simulation_parts.h>
#include <sinew/stepping/detail/speed_limits.h>
#include <sinew/stepping/detail/step_totals.h>
#include <sinew/stepping/equilibrium.h>
#include <sinew/stepping/guarded_steps.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

Particles checked(Particles particles) {
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (!is_computable(particles.position(i)))
      throw bad_input("particle " + std::to_string(particles.id[i]) +
                          " has a position that is too large or not finite",
                      "fill the body again");
  return particles;
}

MakeStepper built_in(kernel::InstructionSet instructions) {
  return [instructions](std::shared_ptr<const Body> body, const Stepping& stepping,
                        Particles& particles) -> std::unique_ptr<Stepper> {
    if (stepping.neighbor_search == NeighborSearch::cells)
      return std::make_unique<CellStepper>(std::move(body), stepping, particles);
    if (stepping.precision == Precision::binary32)
      return std::make_unique<ListStepper<float>>(std::move(body), stepping, particles,
                                                  instructions);
    return std::make_unique<ListStepper<double>>(std::move(body), stepping, particles,
                                                 instructions);
  };
}

}  // namespace

Simulation::Simulation(Body body, Motion motion, Particles particles, const Stepping& stepping,
                       kernel::InstructionSet instructions)
    : Simulation(std::move(body), std::move(motion), std::move(particles), stepping,
                 built_in(instructions)) {}

Simulation::Simulation(Body body, Motion motion, Particles particles, const Stepping& stepping,
                       MakeStepper make)
    : its_(std::make_unique<Impl>(std::move(body), std::move(motion), checked(std::move(particles)),
                                  stepping, std::move(make))) {
  forget_read();
}

Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

const Relaxation* Simulation::relaxation() const {
  return its_->increments ? &its_->increments->relaxation() : nullptr;
}
const std::vector<Offender>& Simulation::offenders() const { return its_->offenders; }
std::int64_t Simulation::steps() const { return its_->steps; }
const Body& Simulation::body() const { return *its_->body; }
const Stepping& Simulation::stepping() const { return its_->stepping; }
const Pose& Simulation::pose() const { return its_->cursor.at(time()); }

double Simulation::mass(std::size_t i) const {
  return mass_of(*its_->body, static_cast<std::size_t>(its_->particles.id[i]),
                 its_->particles.mass);
}

void Simulation::follow(StepPlan plan) {
  its_->plan = std::move(plan);
  its_->plan_from = 0;
  its_->plan_since = 0;
  set_step(its_->plan.step(0));
}

void Simulation::relax(LoadSteps steps) {
  const auto at = [impl = its_.get()](double time) {
    TimedPose moment{time, impl->cursor.at(time)};
    stop(moment.pose);
    return moment;
  };
  its_->increments = std::make_unique<LoadIncrements>(*its_->body, std::move(steps), *its_->stepper,
                                                      its_->stepping, its_->particles, at);
  forget_read();
}

double Simulation::time() const {
  return its_->increments ? relaxation()->time()
                          : its_->plan_since + its_->plan.time(its_->steps - its_->plan_from);
}

void Simulation::play(Motion motion) {
  if (its_->body->grouping || its_->dynamic)
    throw bad_input("groups of particles are made for one motion, which another cannot replace",
                    "set hierarchy.enabled to false");
  its_->motion = std::make_shared<const Motion>(std::move(motion));
  its_->cursor = PoseCursor(its_->body->skeleton, *its_->motion);
  its_->evaluated = false;
}

void Simulation::set_time_step(double step) {
  if (its_->increments || !its_->plan.is_even())
    throw bad_input("the steps follow a plan", "give the step before the run, in the plan");
  if (!(step > 0) || !is_computable(step))
    throw bad_input("a time step of " + three_digits(step) + " s", "give a positive one");
  its_->plan_since = time();
  its_->plan_from = its_->steps;
  its_->plan = StepPlan(step);
}

void Simulation::set_material(const Material& material) {
  check_variant(its_->body->material, material);
  Body body = *its_->body;
  body.material = material;
  change(std::move(body), "material");
}

void Simulation::set_world(std::shared_ptr<const World> world) {
  Body body = *its_->body;
  body.world = std::move(world);
  change(std::move(body), "world");
}

/// The body with another `what`, which goes on as it is.
void Simulation::change(Body body, const char* what) {
  if (its_->body->grouping || its_->dynamic)
    throw bad_input(std::string("groups of particles are made for one ") + what +
                        ", which another cannot replace",
                    "set hierarchy.enabled to false");
  if (its_->increments)
    throw bad_input(
        std::string("a body that is brought to rest has the ") + what + " that it began with",
        std::string("begin a simulation of that ") + what);
  const SimulationState state = save();
  Particles particles = take_particles();
  Stepping first = its_->stepping;
  first.step = its_->unit_of_time;
  auto changed = std::make_shared<Body>(std::move(body));
  std::unique_ptr<Stepper> stepper = its_->make(changed, first, particles);
  stepper->set_step(its_->stepping.step);
  stepper->restore(state);
  its_->body = std::move(changed);
  its_->cursor = PoseCursor(its_->body->skeleton, *its_->motion);
  its_->stepper = std::move(stepper);
  its_->evaluated = false;
  forget_read();
}

void Simulation::set_step(double step) {
  its_->stepping.step = step;
  its_->stepper->set_step(step);
  its_->ledger.set_step(step);
  its_->world_ledger.set_step(step);
}

/// At the moment evaluated last.
Vec3 Simulation::acceleration(std::size_t i) const {
  return its_->forces.total(i) / mass(i) + its_->stepping.gravity;
}

void Simulation::add_to_velocities(double by, const std::function<Vec3(std::size_t i)>& gain) {
  SimulationState state = save();
  sinew::add_to_velocities(state, by, its_->unit_of_time, gain);
  its_->stepper->restore(state);
  its_->stepper->fit_groups();
  forget_read();
}

/// Velocities are half a step behind the positions (velocity Verlet's are read half a step later):
/// from now on half a step of the new size.
void Simulation::change_step(double step) {
  evaluate();
  const bool behind = its_->stepping.integrator != Integrator::explicit_euler && its_->steps > 0;
  const double later = behind ? (its_->stepping.step - step) / 2 : 0;
  add_to_velocities(later, [&](std::size_t i) { return acceleration(i); });
  set_step(step);
}

const LimitedSpeeds& Simulation::limited() const { return its_->limited; }

void Simulation::advance(std::int64_t steps) {
  if (!try_advance(steps)) GuardedSteps(*this).fail();
}

bool Simulation::try_advance(std::int64_t steps) {
  while (steps > 0) {
    its_->evaluated = false;
    if (its_->read) forget_read();
    if (its_->increments) {
      if (!relax_once()) return false;
      --steps;
      continue;
    }
    if (const double next = its_->plan.step(its_->steps - its_->plan_from);
        next != its_->stepping.step)
      change_step(next);
    its_->evaluated = false;  // values are of the moment before these
    const std::int64_t count = steps_of_one_size(steps);
    if (!make_steps(count)) return false;
    steps -= count;
    check_groups();
  }
  return true;
}

/// Returns how many to make at once: until their size changes, or groups are looked at.
std::int64_t Simulation::steps_of_one_size(std::int64_t most) const {
  constexpr std::int64_t at_once = 64;  // whose poses are kept
  most = std::min(most, at_once);
  if (its_->dynamic) most = std::min(most, DynamicGrouping::steps_until_due(its_->steps));
  std::int64_t count = 1;
  while (count < most &&
         its_->plan.step(its_->steps - its_->plan_from + count) == its_->stepping.step)
    ++count;
  return count;
}

bool Simulation::make_steps(std::int64_t count) {
  its_->moments.resize(static_cast<std::size_t>(count));
  for (std::int64_t k = 0; k < count; ++k) {
    TimedPose& moment = its_->moments[static_cast<std::size_t>(k)];
    moment.time = its_->plan_since + its_->plan.time(its_->steps - its_->plan_from + k);
    moment.pose = its_->cursor.at(moment.time);
  }
  its_->sums.clear();
  its_->stepper->advance(its_->moments, its_->sums);
  for (StepSums& one : its_->sums) {
    if (one.failure) {
      its_->offenders = std::move(one.failure->all);
      return false;
    }
    add(one);
  }
  return true;
}

void Simulation::add(const StepSums& sums) {
  its_->ledger.add_step(sums.power, sums.lost);
  its_->world_ledger.add_step(sums.world_power, 0);
  if (its_->steps == 0) its_->held_at_start = sums.held_kinetic;
  ++its_->steps;
}

bool Simulation::relax_once() {
  const auto outcome = its_->increments->iterate(*its_->stepper, its_->steps, its_->offenders);
  its_->stepping.step = relaxation()->step();
  if (outcome == Relaxation::Outcome::failed) return false;
  if (outcome == Relaxation::Outcome::moved) ++its_->steps;
  return true;
}

/// The present one, as the stepper is told: bones of what relaxes stand still.
const TimedPose& Simulation::moment() const {
  its_->moments.resize(std::max<std::size_t>(its_->moments.size(), 1));
  TimedPose& now = its_->moments.front();
  now.time = time();
  now.pose = pose();
  if (its_->increments) stop(now.pose);
  return now;
}

// Groups that change as the body moves.

double Simulation::lost_by_merging() const {
  return its_->dynamic ? its_->dynamic->state().lost : 0;
}
std::int64_t Simulation::regroupings() const {
  return its_->dynamic ? its_->dynamic->state().times : 0;
}

void Simulation::enable_dynamic_groups(const DynamicOptions& options) {
  if (!its_->stepper->has_groups()) refuse_conflicts(Feature::groups, {Feature::cells});
  check_groupable_as_it_moves(*its_->body);
  move_in(make_grouping(*its_->body, std::vector<std::int32_t>(its_->body->rest.size(), -1),
                        none_cubic, options.near));
  its_->dynamic =
      std::make_unique<DynamicGrouping>(its_->body, *its_->motion, its_->particles.mass, options);
  if (auto made = its_->dynamic->first({its_->steps, time(), its_->stepping.step}, particles()))
    take(std::move(*made));
}

/// The particles go on in these groups, from where they are.
void Simulation::move_in(Grouping grouping) {
  its_->body->grouping = std::make_shared<const Grouping>(std::move(grouping));
  its_->stepper->regroup();
  its_->evaluated = false;
  forget_read();
}

void Simulation::check_groups() {
  if (!its_->dynamic || !DynamicGrouping::is_due(its_->steps)) return;
  const auto now = [this]() -> const Particles& { return particles(); };
  if (auto made =
          its_->dynamic->changed(*its_->stepper, {its_->steps, time(), its_->stepping.step}, now))
    take(std::move(*made));
}

void Simulation::take(NewGroups made) {
  const double before = energies().stored();
  move_in(its_->dynamic->grouping_of(made.group));
  its_->dynamic->took(std::move(made), before - energies().stored());
}

/// The particles read last are obsolete, and take half as much memory as the state.
void Simulation::forget_read() const {
  free_motion(its_->particles);
  its_->read = false;
}

const Particles& Simulation::particles() const {
  if (!its_->read) {
    its_->stepper->read(moment(), its_->particles);
    its_->read = true;
  }
  return its_->particles;
}

void Simulation::evaluate() {
  if (its_->evaluated) return;
  its_->balance = its_->stepper->evaluate(moment(), its_->forces);
  its_->evaluated = true;
}

const Forces& Simulation::forces() {
  evaluate();
  return its_->forces;
}

Particles Simulation::take_particles() {
  particles();
  Particles taken;
  taken.radius = its_->particles.radius;
  taken.mass = its_->particles.mass;
  taken.id = its_->particles.id;
  for (const auto axis :
       {&Particles::x, &Particles::y, &Particles::z, &Particles::u, &Particles::v, &Particles::w})
    taken.*axis = std::move(its_->particles.*axis);
  forget_read();
  return taken;
}

Forces Simulation::take_forces() {
  evaluate();
  its_->evaluated = false;
  return std::exchange(its_->forces, {});
}

void Simulation::reuse(Particles particles, Forces forces) {
  if (!its_->evaluated) its_->forces = std::move(forces);
  if (its_->read) return;
  for (const auto axis :
       {&Particles::x, &Particles::y, &Particles::z, &Particles::u, &Particles::v, &Particles::w})
    its_->particles.*axis = std::move(particles.*axis);
}

Unbalanced Simulation::unbalanced() {
  if (!its_->increments) return {};
  const Reaction left = resultant(particles(), forces(), *its_->body, its_->stepping.gravity);
  return {left.force.norm(), left.moment.norm()};
}

Energies Simulation::energies() {
  evaluate();
  Energies energies =
      energies_at({*its_->body, particles(), its_->forces, its_->balance, its_->stepping});
  energies.work_of_bones = its_->ledger.work_until(its_->balance.power);
  energies.dissipation = its_->ledger.dissipation_until(its_->balance.lost) + lost_by_merging();
  if (its_->increments) {  // no moment follows from the one before by a motion
    energies.work_of_bones = energies.work_of_world = energies.dissipation =
        std::numeric_limits<double>::quiet_NaN();
    return energies;
  }
  // Held particles move as prescribed: pins and supports supply their kinetic energy.
  energies.work_of_world = its_->world_ledger.work_until(its_->balance.world_power) +
                           its_->balance.held_kinetic -
                           (its_->steps == 0 ? its_->balance.held_kinetic : its_->held_at_start);
  return energies;
}

std::vector<std::int32_t> Simulation::broken_bonds() const { return its_->stepper->broken_bonds(); }

std::vector<double> Simulation::rest_of_bonds(const NeighborLists& nearest,
                                              const NeighborLists& second) const {
  BondRest rest(nearest, second);
  its_->stepper->read(rest);
  return rest.take();
}

std::vector<Reaction> Simulation::reactions_of_obstacles() {
  evaluate();
  return its_->stepper->reactions().obstacles;
}

std::vector<Reaction> Simulation::support_reactions() {
  evaluate();
  return its_->stepper->reactions().supports;
}

std::vector<Reaction> Simulation::load_reactions() {
  evaluate();
  return its_->stepper->reactions().loads;
}

BoneReactions Simulation::reactions_of_bones() {
  evaluate();
  BoneReactions on;
  on.springs = reactions(particles(), its_->forces.bone, *its_->body, pose());
  WorldReactions others = its_->stepper->reactions();
  on.pins = std::move(others.pins);
  if (its_->body->world)
    on.obstacles =
        reactions_through_obstacles(*its_->body->world, others.obstacles, time(), pose());
  return on;
}

SimulationState Simulation::save() const {
  SimulationState state;
  its_->stepper->save(state);
  state.steps = its_->steps;
  state.body = its_->checksum;
  if (its_->plan.is_even())
    state.even = {its_->plan_from, its_->plan_since, its_->plan.step(0), its_->stepping.step};
  put_part(state, ledgers_part,
           Ledgers{its_->ledger.entries(), its_->world_ledger.entries(), its_->held_at_start});
  put_part(state, "limited speeds", its_->limited);
  if (its_->increments) its_->increments->save(state);
  if (its_->dynamic) {
    put_part(state, "regrouping", its_->dynamic->state());
    put_column(state, "regrouping", "group", its_->body->grouping->group);
  }
  return state;
}

void Simulation::restore(const SimulationState& state) {
  if (state.body != 0 && state.body != its_->checksum)
    throw not_a_state("its particles at rest, their bones or their binding are others");
  if (state.steps < 0) throw not_a_state("it has " + std::to_string(state.steps) + " steps");
  if (find_part(state, ledgers_part) == nullptr) throw not_a_state("it has no ledgers");
  const auto ledgers = part_of<Ledgers>(state, ledgers_part);
  const auto limited = part_of<LimitedSpeeds>(state, "limited speeds");
  if (!ledgers.finite()) throw not_a_state("its energies are not finite");
  if (!limited.is_of(body().rest.size()))
    throw not_a_state("what it says of limited speeds is not valid");
  if (its_->increments) its_->increments->restore(*its_->stepper, state);
  if (its_->dynamic) {
    Grouping grouping =
        its_->dynamic->grouping_of(column_of<std::int32_t>(state, "regrouping", "group"));
    its_->dynamic->restore(part_of<RegroupingState>(state, "regrouping"));
    its_->body->grouping = std::make_shared<const Grouping>(std::move(grouping));
  }
  if (its_->plan.is_even() && state.even.step > 0) its_->plan = StepPlan(state.even.step);
  its_->plan_from = state.even.from;
  its_->plan_since = state.even.since;
  const double last =
      its_->increments ? relaxation()->step()
      : state.even.made > 0
          ? state.even.made
          : its_->plan.step(std::max<std::int64_t>(0, state.steps - its_->plan_from - 1));
  set_step(last);
  its_->stepper->restore(state);
  its_->steps = state.steps;
  its_->ledger.restore(ledgers.of_bones, last);
  its_->world_ledger.restore(ledgers.of_world, last);
  its_->held_at_start = ledgers.held_at_start;
  its_->limited = limited;
  its_->evaluated = false;
  forget_read();
}

ListCounts Simulation::list_counts() const { return its_->stepper->counts(); }

}  // namespace sinew
