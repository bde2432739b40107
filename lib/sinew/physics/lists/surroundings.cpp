// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/lists/surroundings.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>

namespace sinew {
namespace {

constexpr std::size_t pieces_per_look = 64;

bool fills_space(const World& world) { return world.drag.rate > 0 || !world.fields.empty(); }

bool surrounds(const Body& body) {
  if (!body.world) return false;
  const World& world = *body.world;
  return !world.obstacles.empty() || !world.pins.empty() || fills_space(world);
}

}  // namespace

template <class Real>
Surroundings<Real>::Surroundings(std::shared_ptr<const Body> body, const Stepping& stepping,
                                 double mass)
    : body_(std::move(body)),
      stepping_(stepping),
      mass_(mass),
      any_(surrounds(*body_)),
      everywhere_(any_ && fills_space(*body_->world)),
      pins_on_bones_(any_ && std::any_of(body_->world->pins.begin(), body_->world->pins.end(),
                                         [](const Pinned& pin) { return pin.bone != no_bone; })),
      until_middle_(stepping.step / 2) {}

template <class Real>
void Surroundings<Real>::set_step(double step) {
  stepping_.step = step;
  until_middle_ = step / 2;
}

template <class Real>
void Surroundings<Real>::set_order(std::span<const std::int32_t> id) {
  if (!any_) return;
  constexpr std::size_t block = BlockState<Real>::block;
  id_.assign(id.begin(), id.end());
  const std::size_t blocks = (id.size() + block - 1) / block;
  touched_.assign(blocks, 0);
  held_.assign(blocks, 0);
  pieces_.resize((blocks + kernel::blocks_per_piece - 1) / kernel::blocks_per_piece);
  pinned_.clear();
  if (body_->world->pins.empty()) return;
  pin_.assign(id.size(), no_pin);
  std::vector<std::uint32_t> of_id(body_->rest.size(), no_pin);
  for (std::uint32_t pin = 0; pin < body_->world->pins.size(); ++pin)
    of_id[body_->world->pins[pin].particle] = pin;
  for (std::uint32_t k = 0; k < id.size(); ++k) {
    pin_[k] = of_id[static_cast<std::size_t>(id[k])];
    if (pin_[k] == no_pin) continue;
    pinned_.push_back(k);
    held_[k / block] = 1;
  }
  constexpr std::size_t size = kernel::blocks_per_piece * block;
  first_.assign(pieces_.size() + 1, 0);
  for (const std::uint32_t k : pinned_) ++first_[k / size + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
}

template <class Real>
void Surroundings<Real>::hold(const Pose& pose, BlockState<Real>& state, const Units& units,
                              std::vector<double>& moved) const {
  if (pinned_.empty()) return;
  parallel_for(pieces_.size(), pieces_per_look, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece)
      for (std::size_t n = first_[piece]; n < first_[piece + 1]; ++n) {
        const std::uint32_t k = pinned_[n];
        const Pinned& pin = body_->world->pins[pin_[k]];
        const PinPose place = pin_pose(pin, body_->rest[pin.particle], body_->skeleton, pose);
        const Vec3 before = state.position(k, units);
        state.set_position(k, place.position, units);
        state.set_velocity(k, place.velocity, units);
        moved[piece] = std::max(moved[piece], (state.position(k, units) - before).norm());
      }
  });
}

template <class Real>
Box Surroundings<Real>::box_of(std::size_t first, std::size_t last) const {
  Box box;
  for (std::size_t k = first; k < last; ++k) box.extend(state_->position(k, units_));
  return box;
}

/// Whether an obstacle may touch particles in a box.
template <class Real>
bool Surroundings<Real>::may_touch(const Box& box) const {
  const World& world = *body_->world;
  const double reach = box.diagonal().norm() / 2 + body_->material.pair.r;
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
    const RigidFrame& frame = now_.obstacles[k].frame;
    const Vec3 center = frame.rotation.transpose() * (box.center() - frame.origin);
    if (may_be_near(world.obstacles[k].shape, center, reach * (1 + 1e-5))) return true;
  }
  return false;
}

/// `box`: around the piece.
template <class Real>
void Surroundings<Real>::find_touched(std::size_t piece, const Box& box) {
  constexpr std::size_t block = BlockState<Real>::block;
  const std::size_t first = piece * kernel::blocks_per_piece;
  const std::size_t last = std::min(first + kernel::blocks_per_piece, touched_.size());
  const bool some = everywhere_ || may_touch(box);
  for (std::size_t k = first; k < last; ++k) {
    touched_[k] = everywhere_ || (!held_.empty() && held_[k] != 0) ? 1 : 0;
    if (some && touched_[k] == 0)
      touched_[k] = may_touch(box_of(k * block, std::min((k + 1) * block, state_->size()))) ? 1 : 0;
  }
}

template <class Real>
void Surroundings<Real>::begin(const Pose& pose, double time, BlockState<Real>& state,
                               const Units& units, const VerletLists<Real>& lists, Points* forces) {
  if (!any_) return;
  now_ = world_at(*body_->world, time, pose);
  state_ = &state;
  pose_ = &pose;
  units_ = units;
  forces_ = forces;
  if (forces_ != nullptr) forces_->assign(state.size(), Vec3::Zero());
  parallel_for(pieces_.size(), pieces_per_look, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) {
      pieces_[piece].sums = {};
      pieces_[piece].reactions.assign(body_->world->obstacles.size(), {});
      const bool pins = pins_on_bones_ && first_[piece] < first_[piece + 1];
      pieces_[piece].of_pins.assign(pins ? body_->skeleton.size() : 0, {});
      find_touched(piece, lists.box_of(piece, units_));
    }
  });
}

template <class Real>
kernel::Surroundings<Real> Surroundings<Real>::calls() {
  if (!any_) return {};
  return {touched_.data(), this, act};
}

template <class Real>
void Surroundings<Real>::act(void* context, std::ptrdiff_t i, int count,
                             Real* const acceleration[3], Real* held) {
  auto& self = *static_cast<Surroundings*>(context);
  const double unit = self.units_.length / (self.units_.time * self.units_.time);
  for (int n = 0; n < count; ++n) {
    const auto k = static_cast<std::size_t>(i + n);
    held[n] = 0;
    if (k >= self.state_->size()) continue;
    const Vec3 before = unit * Vec3(acceleration[0][n], acceleration[1][n], acceleration[2][n]);
    Vec3 after = before;
    self.act_on(k, after, held[n]);
    if (after == before) continue;  // not even rounded
    for (int axis = 0; axis < 3; ++axis)
      acceleration[axis][n] = static_cast<Real>(after[axis] / unit);
  }
}

/// Pins take what all other forces leave.
template <class Real>
void Surroundings<Real>::act_on(std::size_t k, Vec3& acceleration, Real& held) {
  const Vec3 position = state_->position(k, units_), velocity = state_->velocity(k, units_);
  const HeldParticle particle{
      {}, position, velocity, body_->material.pair.r, static_cast<std::size_t>(id_[k])};
  Piece& piece = pieces_[k / (kernel::blocks_per_piece * BlockState<Real>::block)];
  const Vec3 others = mass_ * acceleration;
  const ParticleWorld world =
      world_on(particle, mass_, *body_->world, now_, others, stepping_.step, piece.reactions);
  const Vec3 unheld = others + world.force();
  const bool pin = is_held(k);
  acceleration = pin ? Vec3(Vec3::Zero()) : Vec3(acceleration + world.force() / mass_);
  held = pin ? Real(1) : Real(0);
  const Vec3 middle = velocity + until_middle_ * acceleration;
  WorldSums& sums = piece.sums;
  sums.power += world.power + world.field.dot(middle);
  sums.lost += world.losing_power - world.losing.dot(middle);
  sums.contact_energy += world.contact_energy;
  if (pin) {
    sums.power -= unheld.dot(middle);
    const Pinned& held_by = body_->world->pins[pin_[k]];
    add_reaction(held_by, {position, velocity}, unheld, *pose_, piece.of_pins);
    sums.held_kinetic += mass_ / 2 * middle.squaredNorm();
  }
  if (forces_ != nullptr) (*forces_)[k] = pin ? Vec3(-others) : world.force();
}

template <class Real>
WorldSums Surroundings<Real>::sums() const {
  WorldSums all;
  for (const Piece& piece : pieces_) {
    all.power += piece.sums.power;
    all.lost += piece.sums.lost;
    all.contact_energy += piece.sums.contact_energy;
    all.held_kinetic += piece.sums.held_kinetic;
  }
  return all;
}

template <class Real>
std::vector<Reaction> Surroundings<Real>::reactions() const {
  std::vector<Reaction> all(any_ ? body_->world->obstacles.size() : 0);
  for (const Piece& piece : pieces_)
    for (std::size_t k = 0; k < std::min(all.size(), piece.reactions.size()); ++k) {
      all[k].force += piece.reactions[k].force;
      all[k].moment += piece.reactions[k].moment;
    }
  return all;
}

template <class Real>
std::vector<Reaction> Surroundings<Real>::reactions_of_pins() const {
  std::vector<Reaction> all(pins_on_bones_ ? body_->skeleton.size() : 0);
  for (const Piece& piece : pieces_)
    for (std::size_t b = 0; b < piece.of_pins.size(); ++b) all[b] += piece.of_pins[b];
  return all;
}

template class Surroundings<double>;
template class Surroundings<float>;

}  // namespace sinew
