// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/simulation.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <sinew/analysis/instability.h>
#include <sinew/body/solid.h>
#include <sinew/core/error.h>
#include <sinew/core/parallel.h>
#include <sinew/core/text.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_sum = 512;

Particles& checked(Particles& particles) {
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (!is_computable(particles.position(i)))
      throw bad_input("particle " + std::to_string(particles.id[i]) +
                          " has a position that is too large or not finite",
                      "fill the body again");
  return particles;
}

bool moved_less(const Offender& a, const Offender& b) {
  return a.finite != b.finite ? a.finite : a.moved < b.moved;
}

bool is_finite(const LedgerEntries& ledger) {
  return std::isfinite(ledger.work) && std::isfinite(ledger.dissipation) &&
         std::isfinite(ledger.power);
}

}  // namespace

Simulation::Stepper Simulation::make_stepper(const std::shared_ptr<const Body>& body,
                                             const Stepping& stepping, Particles& particles,
                                             kernel::InstructionSet instructions) {
  if (stepping.neighbor_search == NeighborSearch::cells)
    return CellStepper(body, stepping, particles);
  if (stepping.precision == Precision::binary32)
    return ListStepper<float>(body, stepping, particles, instructions);
  return ListStepper<double>(body, stepping, particles, instructions);
}

Simulation::Simulation(Body body, Motion motion, Particles particles, const Stepping& stepping,
                       kernel::InstructionSet instructions)
    : body_(std::make_shared<Body>(std::move(body))),
      motion_(std::make_shared<const Motion>(std::move(motion))),
      cursor_(body_->skeleton, *motion_),
      stepping_(stepping),
      plan_(stepping.step),
      unit_of_time_(stepping.step),
      stepper_(make_stepper(body_, stepping, checked(particles), instructions)),
      ledger_(stepping.step),
      world_ledger_(stepping.step),
      particles_(std::move(particles)) {
  forget_read();
}

void Simulation::follow(StepPlan plan) {
  plan_ = std::move(plan);
  set_step(plan_.step(0));
}

double Simulation::time() const { return relaxation_ ? relaxation_->time() : plan_.time(steps_); }

void Simulation::play(Motion motion) {
  if (body_->grouping || dynamic_)
    throw bad_input("groups of particles are made for one motion, which another cannot replace",
                    "set hierarchy.enabled to false");
  motion_ = std::make_shared<const Motion>(std::move(motion));
  cursor_ = PoseCursor(body_->skeleton, *motion_);
  evaluated_ = false;
}

void Simulation::set_step(double step) {
  stepping_.step = step;
  std::visit([&](auto& stepper) { stepper.set_step(step); }, stepper_);
  ledger_.set_step(step);
  world_ledger_.set_step(step);
}

/// Velocities are half a step behind the positions (velocity Verlet's are read half a step later):
/// from now on half a step of the new size.
void Simulation::change_step(double step) {
  evaluate();
  const bool behind = stepping_.integrator != Integrator::explicit_euler && steps_ > 0;
  const double later = behind ? (stepping_.step - step) / 2 : 0;
  SimulationState state = save();
  const double unit = std::holds_alternative<MovingInSingle>(state.moving)
                          ? state.whole_numbers.length / unit_of_time_
                          : 1;
  const auto shift = [&](auto& moving) {
    for (std::size_t k = 0; k < moving.x[0].size(); ++k) {
      const std::size_t i = state.order.empty() ? k : state.order[k];
      const Vec3 gain = later / unit * (forces_.total(i) / mass(i) + stepping_.gravity);
      for (int axis = 0; axis < 3; ++axis) {
        auto& v = moving.v[axis][k];
        v = static_cast<std::remove_reference_t<decltype(v)>>(v + gain[axis]);
      }
    }
  };
  std::visit(shift, state.moving);
  std::visit([&](auto& stepper) { stepper.restore(state), stepper.fit_groups(); }, stepper_);
  set_step(step);
  forget_read();
}

void Simulation::step() {
  evaluated_ = false;
  if (read_) forget_read();
  if (relaxation_) return relax_once();
  if (const double next = plan_.step(steps_); next != stepping_.step) change_step(next);
  const Pose& now = pose();
  set_time();
  StepSums sums = std::visit([&](auto& stepper) { return stepper.step(now); }, stepper_);
  if (sums.failure) {
    offenders_ = std::move(sums.failure->all);
    fail();
  }
  ledger_.add_step(sums.power, sums.lost);
  world_ledger_.add_step(sums.world_power, 0);
  if (steps_ == 0) held_at_start_ = sums.held_kinetic;
  ++steps_;
  check_groups();
}

void Simulation::set_time() const {
  std::visit([&](auto& stepper) { stepper.set_time(time()); }, stepper_);
}

/// The particles read last are obsolete, and take half as much memory as the state.
void Simulation::forget_read() {
  free_motion(particles_);
  read_ = false;
}

void Simulation::fail() {
  const Offender& worst = *std::max_element(offenders_.begin(), offenders_.end(), moved_less);
  const std::int32_t id = particles_.id[worst.particle];
  const auto bones = body_->binding.of(id);
  evaluate();
  const std::string why =
      cause_and_cure({*body_, pose(), time(), particles(), forces_, stepping_}, worst.particle);
  const std::string where =
      bones.empty() ? "" : " on bone '" + body_->skeleton.bones[bones.front().bone].name + "'";
  throw Error(
      Exit::unstable,
      "step " + std::to_string(steps_) + " at " + three_digits(time()) + " s: particle " +
          std::to_string(id) + where +
          (worst.finite ? " moved over " + three_digits(most_radii_per_step) +
                              (bones.empty() ? " r relative to its previous motion in one step"
                                             : " r relative to its bone in one step")
                        : std::string(" reached a value that is not finite")) +
          ": " + why);
}

const Particles& Simulation::particles() const {
  if (!read_) {
    const Pose& now = pose_of_stepper();
    set_time();
    std::visit([&](auto& stepper) { stepper.read(now, particles_); }, stepper_);
    read_ = true;
  }
  return particles_;
}

void Simulation::evaluate() {
  if (evaluated_) return;
  const Pose& now = pose_of_stepper();
  set_time();
  balance_ = std::visit([&](auto& stepper) { return stepper.evaluate(now, forces_); }, stepper_);
  evaluated_ = true;
}

const Forces& Simulation::forces() {
  evaluate();
  return forces_;
}

Particles Simulation::take_particles() {
  particles();
  Particles taken;
  taken.radius = particles_.radius;
  taken.mass = particles_.mass;
  taken.id = particles_.id;
  for (const auto axis :
       {&Particles::x, &Particles::y, &Particles::z, &Particles::u, &Particles::v, &Particles::w})
    taken.*axis = std::move(particles_.*axis);
  forget_read();
  return taken;
}

Forces Simulation::take_forces() {
  evaluate();
  evaluated_ = false;
  return std::exchange(forces_, {});
}

void Simulation::reuse(Particles particles, Forces forces) {
  if (!evaluated_) forces_ = std::move(forces);
  if (read_) return;
  for (const auto axis :
       {&Particles::x, &Particles::y, &Particles::z, &Particles::u, &Particles::v, &Particles::w})
    particles_.*axis = std::move(particles.*axis);
}

Energies Simulation::energies() {
  evaluate();
  const Particles& now = particles();
  // Velocities are half a step behind the positions, except in velocity Verlet.
  const double behind =
      stepping_.integrator == Integrator::velocity_verlet ? 0 : stepping_.step / 2;
  Energies energies;
  energies.kinetic =
      parallel_sum(now.size(), particles_per_sum, [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) {
          const Vec3 acceleration = forces_.total(i) / mass(i) + stepping_.gravity;
          sum += mass(i) / 2 * (now.velocity(i) + behind * acceleration).squaredNorm();
        }
        return sum;
      });
  energies.gravity =
      parallel_sum(now.size(), particles_per_sum, [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i)
          sum -= mass(i) * stepping_.gravity.dot(now.position(i));
        return sum;
      });
  energies.pair = balance_.pair_energy;
  energies.bone = balance_.bone_energy;
  energies.work_of_bones = ledger_.work_until(balance_.power);
  energies.dissipation = ledger_.dissipation_until(balance_.lost) + regrouping_.lost;
  energies.contact = balance_.contact_energy;
  if (relaxation_) {  // no moment follows from the one before by a motion
    energies.work_of_bones = energies.work_of_world = energies.dissipation =
        std::numeric_limits<double>::quiet_NaN();
    return energies;
  }
  // Held particles move as prescribed: pins and supports supply their kinetic energy.
  energies.work_of_world = world_ledger_.work_until(balance_.world_power) + balance_.held_kinetic -
                           (steps_ == 0 ? balance_.held_kinetic : held_at_start_);
  return energies;
}

std::vector<std::int32_t> Simulation::broken_bonds() const {
  return std::visit([](const auto& stepper) { return stepper.broken_bonds(); }, stepper_);
}

std::vector<double> Simulation::rest_of_bonds(const NeighborLists& nearest,
                                              const NeighborLists& second) const {
  BondRest rest(nearest, second);
  std::visit([&](const auto& stepper) { stepper.read(rest); }, stepper_);
  return rest.take();
}

std::vector<Reaction> Simulation::reactions_of_obstacles() {
  evaluate();
  return std::visit([](const auto& stepper) { return stepper.reactions_of_obstacles(); }, stepper_);
}

std::vector<Reaction> Simulation::of_supports() {
  evaluate();
  return std::visit([](const auto& stepper) { return stepper.of_supports(); }, stepper_);
}

std::vector<Reaction> Simulation::of_loads() {
  evaluate();
  return std::visit([](const auto& stepper) { return stepper.of_loads(); }, stepper_);
}

BoneReactions Simulation::reactions_of_bones() {
  evaluate();
  BoneReactions on;
  on.springs = reactions(particles(), forces_.bone, *body_, pose());
  on.pins = std::visit([](const auto& stepper) { return stepper.reactions_of_pins(); }, stepper_);
  if (body_->world)
    on.obstacles =
        reactions_through_obstacles(*body_->world, reactions_of_obstacles(), time(), pose());
  return on;
}

SimulationState Simulation::save() const {
  SimulationState state;
  std::visit([&](auto& stepper) { stepper.save(state); }, stepper_);
  state.steps = steps_;
  state.ledger = ledger_.entries();
  state.world_ledger = world_ledger_.entries();
  state.held_at_start = held_at_start_;
  if (relaxation_) state.relaxation = relaxation_->state();
  if (dynamic_) state.grouping = body_->grouping->group, state.regrouping = regrouping_;
  return state;
}

void Simulation::restore(const SimulationState& state) {
  if (state.steps < 0) throw not_a_state("it has " + std::to_string(state.steps) + " steps");
  if (!is_finite(state.ledger) || !is_finite(state.world_ledger) ||
      !std::isfinite(state.held_at_start))
    throw not_a_state("its energies are not finite");
  if (relaxation_) relaxation_->restore(state.relaxation);
  if (dynamic_) restore_grouping(state);
  const double last =
      relaxation_ ? relaxation_->step() : plan_.step(std::max<std::int64_t>(0, state.steps - 1));
  set_step(last);
  std::visit([&](auto& stepper) { stepper.restore(state); }, stepper_);
  steps_ = state.steps;
  ledger_.restore(state.ledger, last);
  world_ledger_.restore(state.world_ledger, last);
  held_at_start_ = state.held_at_start;
  evaluated_ = false;
  forget_read();
}

ListCounts Simulation::list_counts() const {
  return std::visit(
      [](const auto& stepper) {
        if constexpr (requires { stepper.counts(); })
          return stepper.counts();
        else
          return ListCounts{};
      },
      stepper_);
}

}  // namespace sinew
