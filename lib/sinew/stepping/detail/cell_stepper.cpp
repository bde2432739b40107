// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/detail/cell_stepper.h>

#include <algorithm>
#include <atomic>
#include <utility>

#include <sinew/body/pair_pass.h>
#include <sinew/core/capabilities.h>
#include <sinew/core/parallel.h>
#include <sinew/material/laws.h>
#include <sinew/world/references.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_cell_task = 512;

std::optional<Solid> solid_of(const Body& body, const Particles& particles) {
  if (!remembers_neighbors(body.material)) return std::nullopt;
  Points rest;
  rest.reserve(particles.size());
  for (const std::int32_t id : particles.id) rest.push_back(body.rest[id]);
  Solid::Passing passing;
  if (body.pass_through.any())
    passing = [&body, id = particles.id](std::size_t i, std::size_t j) {
      return pass_through(body, static_cast<std::size_t>(id[i]), static_cast<std::size_t>(id[j]));
    };
  return Solid(body.material, std::move(rest), particles.id, body.factors, body.local,
               std::move(passing));
}

}  // namespace

CellStepper::CellStepper(std::shared_ptr<const Body> body, const Stepping& stepping,
                         Particles particles)
    : body_(std::move(body)),
      stepping_(stepping),
      particles_(std::move(particles)),
      references_(body_) {
  if (body_->grouping) refuse_conflicts(Feature::groups, {Feature::cells});
  solid_ = solid_of(*body_, particles_);
  references_.set_order(particles_.id);
  sliding_ = SlidingContacts(*body_);
  if (!body_->world) return;
  place_.resize(particles_.size());
  for (std::size_t i = 0; i < place_.size(); ++i) place_[particles_.id[i]] = i;
  for (const Load& load : body_->world->loads) loads_.emplace_back(load);
  if (body_->world->pins.empty()) return;
  is_held_.resize(particles_.size());
  for (const Pinned& pin : body_->world->pins) {
    held_.push_back(place_[pin.particle]);
    is_held_[held_.back()] = true;
  }
}

/// Moves held particles exactly to their positions: no error accumulates over steps.
void CellStepper::hold(const TimedPose& moment) {
  if (held_.empty()) return;
  const World& world = *body_->world;
  const Pose& pose = moment.pose;
  const std::vector<ObstaclePose> supports = poses_of(world.supports, moment.time, pose);
  for (std::size_t k = 0; k < held_.size(); ++k) {
    const Pinned& pin = world.pins[k];
    const std::size_t i = held_[k];
    const PinPose place =
        held_place(pin, body_->rest[pin.particle], world, supports, body_->skeleton, pose);
    const Vec3 x = particles_.position(i), v = particles_.velocity(i);
    particles_.set_position(i, x - held_part(pin, x) + held_part(pin, place.position));
    particles_.set_velocity(i, v - held_part(pin, v) + held_part(pin, place.velocity));
  }
}

/// The sum of all loads on each particle.
void CellStepper::find_loads(const WorldNow& now) {
  load_.assign(particles_.size(), Vec3::Zero());
  of_loads_.assign(loads_.size(), {});
  for (std::size_t n = 0; n < loads_.size(); ++n) {
    const Load& load = body_->world->loads[n];
    loads_[n].find(
        now.loads[n],
        [&](std::size_t at) { return particles_.position(place_[load.particles[at]]); },
        stepping_now_);
    for (std::size_t k = 0; k < load.particles.size(); ++k)
      load_[place_[load.particles[k]]] += loads_[n].force(k);
  }
}

/// After all other forces: dry friction answers them, and pins and supports take whatever is left.
void CellStepper::find_world_forces(const TimedPose& moment) {
  const World& world = *body_->world;
  const WorldNow now = world_at(world, moment.time, moment.pose);
  muscle_forces(world.muscles, now.activations, particles_, muscle_);
  find_loads(now);
  reactions_.assign(world.obstacles.size(), {});
  around_.resize(particles_.size());
  forces_.world = muscle_;
  for (std::size_t i = 0; i < friction_.size(); ++i) forces_.world[i] += friction_[i];
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const ParticleState particle{{},
                                 particles_.position(i),
                                 particles_.velocity(i),
                                 particles_.radius,
                                 static_cast<std::size_t>(particles_.id[i])};
    forces_.world[i] += load_[i];
    const Vec3 weight = mass(i) * stepping_.gravity;
    around_[i] = world_on(particle, mass(i), world, now, forces_.total(i) + weight, stepping_.step,
                          reactions_);
    forces_.world[i] += around_[i].force();
  }
  hold_back(now, moment.pose);
  for (std::size_t n = 0; n < loads_.size(); ++n)
    for (std::size_t k = 0; k < world.loads[n].particles.size(); ++k) {
      const Load& load = world.loads[n];
      const std::size_t i = place_[load.particles[k]];
      const Vec3 force = loads_[n].force(k);
      of_loads_[n] +=
          {force, (particles_.position(i) - load.pivot).cross(force), force.dot(velocity_now(i))};
    }
}

/// Pins and supports answer all other forces on what they hold.
void CellStepper::hold_back(const WorldNow& now, const Pose& pose) {
  const World& world = *body_->world;
  of_pins_.assign(held_.empty() ? 0 : pose.size(), {});
  of_supports_.assign(world.supports.size(), {});
  for (std::size_t k = 0; k < held_.size(); ++k) {
    const Pinned& pin = world.pins[k];
    const std::size_t i = held_[k];
    const Vec3 unheld = forces_.total(i) + mass(i) * stepping_.gravity;
    const PinPose at{particles_.position(i), particles_.velocity(i)};
    if (pin.is_pin())
      add_reaction(pin, at, unheld, pose, of_pins_);
    else
      add_answer(pin, at, -unheld, now.supports, of_supports_);
    forces_.world[i] -= held_part(pin, unheld);
  }
}

/// Finds the friction of the body on itself.
void CellStepper::find_friction() {
  friction_.assign(particles_.size(), Vec3::Zero());
  const Material& material = body_->material;
  const CellGrid cells = cells_of(particles_, 2 * material.pair.r);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    std::vector<Touch> touches;
    const std::int32_t id = particles_.id[i];
    for_each_neighbor(
        particles_, cells, 2 * material.pair.r, i,
        [&](std::uint32_t j, const Vec3& apart, double d) {
          if (d > 0 && sliding_.rub(id, particles_.id[j]))
            touches.push_back({particles_.id[j], apart / d, law_of(material).force(material, d),
                               particles_.velocity(i) - particles_.velocity(j)});
        });
    friction_[i] = sliding_.force(id, touches, stepping_.step, stepping_now_);
  }
}

/// Adds damping relative to what holds the body to that of eq. 2.
void CellStepper::add_rigid_damping(const TimedPose& now) {
  if (references_.damping() == nullptr) return;
  references_.follow_cracks(steps_, *this);
  Particles& p = particles_;
  const kernel::State<double> state{{p.x.data(), p.y.data(), p.z.data()},
                                    {p.u.data(), p.v.data(), p.w.data()}};
  references_.find(now, state, {});
  of_rigid_.pins.assign(now.pose.size(), {});
  of_rigid_.supports.assign(body_->world ? body_->world->supports.size() : 0, {});
  rigid_power_ = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto id = static_cast<std::size_t>(p.id[i]);
    const Vec3 at = p.position(i), force = references_.force(id, mass(i), at, p.velocity(i));
    forces_.damping[i] += force;
    rigid_power_ += force.dot(references_.damping()->velocity_at(id, at, references_.motions()));
    add_reactions(*references_.damping(), id, at, force, references_.motions(), of_rigid_.pins,
                  of_rigid_.supports);
  }
}

void CellStepper::find_forces(const TimedPose& now) {
  hold(now);
  if (solid_) {
    solid_->branches().begin(stepping_.step);
    solid_->forces(particles_, forces_);
  } else {
    pair_forces(particles_, *body_, forces_);
  }
  bone_forces(particles_, *body_, now.pose, forces_);
  add_rigid_damping(now);
  forces_.world.clear();
  friction_.clear();
  if (sliding_.any()) find_friction();
  if (body_->world)
    find_world_forces(now);
  else
    forces_.world = friction_;
}

double CellStepper::stored_in_pairs() {
  return solid_ ? solid_->energy(particles_) : pair_energy(particles_, *body_);
}

std::vector<std::int32_t> CellStepper::broken_bonds() const {
  if (!solid_ || !law_of(body_->material).has_bonds) return {};
  std::vector<std::int32_t> broken(particles_.size());
  for (std::size_t i = 0; i < broken.size(); ++i) broken[i] = solid_->broken(i);
  return broken;
}

void CellStepper::read(BondRest& rest) const {
  if (!solid_ || !law_of(body_->material).has_bonds) return;
  const auto set = [&](const Bonds& bonds, bool nearest) {
    for (std::size_t i = 0; i < particles_.size(); ++i)
      for (std::uint32_t e = bonds.neighbors.first[i]; e < bonds.neighbors.first[i + 1]; ++e)
        if (bonds.whole(e))
          rest.set(particles_.id[i], particles_.id[bonds.neighbors.neighbor[e]], nearest,
                   solid_->free_length(nearest, e));
  };
  set(solid_->bonds().nearest, true);
  set(solid_->bonds().second, false);
}

void CellStepper::save(SimulationState& state) {
  const Particles& now = particles_;
  state.moving = MovingInDouble{{now.x, now.y, now.z}, {now.u, now.v, now.w}};
  state.kicked = kicked_;
  sliding_.save(state);
  references_.save(state);
  save_loads(loads_, state);
  if (!solid_) return;
  put_column(state, "bonds of cells", "rest", solid_->rest_lengths());
  solid_->branches().save(state);
}

void CellStepper::restore(const SimulationState& state) {
  const auto* moving = std::get_if<MovingInDouble>(&state.moving);
  if (moving == nullptr) throw not_a_state("it is in single precision");
  check_moving(*moving, particles_.size());
  for (const auto& axis : moving->x)
    if (!std::all_of(axis.begin(), axis.end(), [](double x) { return is_computable(x); }))
      throw not_a_state("a particle is far away from the body");
  if (solid_) {
    solid_->branches().restore(state);
    solid_->restore(column_of<double>(state, "bonds of cells", "rest"));
  } else if (find_part(state, "bonds of cells") != nullptr) {
    throw not_a_state("it has bonds");
  }
  sliding_.restore(state);
  references_.restore(state);
  references_.set_order(particles_.id);
  steps_ = state.steps;
  restore_loads(state, loads_);
  Particles& now = particles_;
  now.x = moving->x[0], now.y = moving->x[1], now.z = moving->x[2];
  now.u = moving->v[0], now.v = moving->v[1], now.w = moving->v[2];
  kicked_ = state.kicked;
}

double CellStepper::mass(std::size_t i) const {
  return mass_of(*body_, static_cast<std::size_t>(particles_.id[i]), particles_.mass);
}

Vec3 CellStepper::acceleration(std::size_t i) const {
  return forces_.total(i) / mass(i) + stepping_.gravity;
}

/// Velocities are half a step behind the forces, for velocity Verlet as well.
Vec3 CellStepper::velocity_now(std::size_t i) const {
  return particles_.velocity(i) + stepping_.step / 2 * acceleration(i);
}

void CellStepper::add_world(StepSums& sums) const {
  for (std::size_t i = 0; i < around_.size(); ++i) {
    const Vec3 velocity = velocity_now(i);
    const ParticleWorld& on = around_[i];
    sums.lost += on.losing_power - on.losing.dot(velocity);
    sums.world_power += on.power + (on.field + load_[i] + muscle_[i]).dot(velocity);
  }
  for (std::size_t k = 0; k < held_.size(); ++k) {
    const std::size_t i = held_[k];
    const Vec3 own = held_part(body_->world->pins[k], velocity_now(i));
    Vec3 others = around_[i].force() + load_[i] + muscle_[i];
    if (!friction_.empty()) others += friction_[i];
    sums.world_power += (forces_.world[i] - others).dot(own);
    sums.held_kinetic += mass(i) / 2 * own.squaredNorm();
  }
}

StepSums CellStepper::sums() const {
  const std::size_t n = particles_.size();
  StepSums sums;
  for (const Reaction& of_bone : of_rigid_.pins) sums.power += of_bone.power;
  sums.world_power = rigid_power_ - sums.power;
  sums.power += parallel_sum(n, particles_per_cell_task, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += forces_.bone_power[i];
    return sum;
  });
  sums.lost = parallel_sum(n, particles_per_cell_task, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 velocity = velocity_now(i);
      sum += forces_.bone_damping_power[i] - forces_.bone_damping[i].dot(velocity) -
             forces_.damping[i].dot(velocity);
    }
    return sum;
  });
  sums.lost += rigid_power_;
  for (std::size_t i = 0; i < friction_.size(); ++i) sums.lost -= friction_[i].dot(velocity_now(i));
  if (body_->world) add_world(sums);
  return sums;
}

void CellStepper::move(std::size_t i, double kick) {
  const Vec3 x = particles_.position(i), v = particles_.velocity(i);
  const Vec3 kicked = v + kick * acceleration(i);
  const bool drift_first = stepping_.integrator == Integrator::explicit_euler;
  particles_.set_position(i, x + stepping_.step * (drift_first ? v : kicked));
  particles_.set_velocity(i, kicked);
}

/// Over the step, relative to the bone or, without one and for what is held, to the motion before.
Vec3 CellStepper::moved(std::size_t i, const Particle& before, const Pose& pose) const {
  const auto bones = body_->binding.of(particles_.id[i]);
  const Vec3 carried = bones.empty() || (!is_held_.empty() && is_held_[i])
                           ? before.velocity
                           : pose[bones.front().bone].velocity_at(before.position);
  return stepping_.step * (particles_.velocity(i) - carried);
}

bool CellStepper::sound(std::size_t i, const Particle& before, const Pose& pose) const {
  const double most = max_radii_ * particles_.radius;
  // Also false for values that are not numbers.
  return moved(i, before, pose).squaredNorm() <= most * most && particles_.position(i).allFinite();
}

/// Restores the state before the step, and returns the particles that failed in it.
Failure CellStepper::take_back(const Pose& pose) {
  Failure failure;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const Particle before{{before_.x[0][i], before_.x[1][i], before_.x[2][i]},
                          {before_.v[0][i], before_.v[1][i], before_.v[2][i]}};
    if (sound(i, before, pose)) continue;
    const Vec3 displacement = moved(i, before, pose);
    failure.all.push_back({i, displacement.allFinite() && particles_.position(i).allFinite(),
                           displacement.allFinite() ? displacement.norm() : 0});
  }
  failure.first = failure.all.front();
  Particles& now = particles_;
  now.x = before_.x[0], now.y = before_.x[1], now.z = before_.x[2];
  now.u = before_.v[0], now.v = before_.v[1], now.w = before_.v[2];
  return failure;
}

void CellStepper::advance(std::span<const TimedPose> begins, std::vector<StepSums>& sums) {
  for (const TimedPose& begin : begins) {
    sums.push_back(step(begin));
    if (sums.back().failure) return;
  }
}

StepSums CellStepper::step(const TimedPose& moment) {
  const Pose& pose = moment.pose;
  stepping_now_ = true;
  find_forces(moment);
  stepping_now_ = false;
  StepSums sums = this->sums();
  if (solid_) sums.lost += solid_->evolve(particles_, stepping_.step) / stepping_.step;
  const bool half = stepping_.integrator == Integrator::velocity_verlet && !kicked_;
  const double kick = half ? stepping_.step / 2 : stepping_.step;
  const Particles& now = particles_;
  before_ = {{now.x, now.y, now.z}, {now.u, now.v, now.w}};
  std::atomic<bool> failed = false;
  parallel_for(now.size(), particles_per_cell_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Particle before{particles_.position(i), particles_.velocity(i)};
      move(i, kick);
      if (!sound(i, before, pose)) failed = true;
    }
  });
  if (failed) {
    sums.failure = take_back(pose);
    return sums;
  }
  kicked_ = true;
  ++steps_;
  if (solid_) solid_->branches().advance(stepping_.step);
  return sums;
}

Balance CellStepper::evaluate(const TimedPose& moment, Forces& forces) {
  find_forces(moment);
  const StepSums now = sums();
  forces.pair = forces_.pair;
  forces.damping = forces_.damping;
  forces.bone = forces_.bone;
  forces.world = forces_.world;
  forces.neighbors = forces_.neighbors;
  double contact = 0;
  for (const ParticleWorld& on : around_) contact += on.contact_energy;
  return {
      now.power,       now.lost, stored_in_pairs(), bone_energy(particles_, *body_, moment.pose),
      now.world_power, contact,  now.held_kinetic};
}

void CellStepper::read(const TimedPose& now, Particles& particles) {
  hold(now);
  particles = particles_;
  if (stepping_.integrator != Integrator::velocity_verlet || !kicked_) return;
  Forces forces;
  evaluate(now, forces);
  for (std::size_t i = 0; i < particles.size(); ++i)
    particles.set_velocity(i, particles.velocity(i) + stepping_.step / 2 * acceleration(i));
}

}  // namespace sinew
