// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/detail/surroundings.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include <sinew/body/grouping.h>
#include <sinew/core/error.h>
#include <sinew/core/lines.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/material/laws.h>

namespace sinew {
namespace {

constexpr std::size_t pieces_per_look = 64;

bool fills_space(const World& world) { return world.drag.rate > 0 || !world.fields.empty(); }

bool surrounds(const Body& body) {
  if (body.material.friction > 0) return true;
  if (!body.world) return false;
  const World& world = *body.world;
  return !world.obstacles.empty() || !world.pins.empty() || !world.loads.empty() ||
         fills_space(world);
}

}  // namespace

template <class Real>
Surroundings<Real>::Surroundings(std::shared_ptr<const Body> body, const Stepping& stepping,
                                 double mass, std::size_t kept)
    : body_(std::move(body)),
      world_(body_->world ? body_->world : std::make_shared<const World>()),
      stepping_(stepping),
      mass_(mass),
      kept_(kept),
      any_(surrounds(*body_)),
      everywhere_(any_ && fills_space(*world_)),
      acts_in_space_(everywhere_ || (any_ && !world_->obstacles.empty())),
      pins_on_bones_(any_ && std::any_of(world_->pins.begin(), world_->pins.end(),
                                         [](const Pinned& pin) { return pin.bone != no_bone; })),
      until_middle_(stepping.step / 2) {
  if (!any_) return;
  sliding_ = SlidingContacts(*body_);
  loads_ = LoadLists<Real>(world_->loads, mass_);
}

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
  set_pins(id);
  loads_.set_order(id);
}

template <class Real>
void Surroundings<Real>::set_pins(std::span<const std::int32_t> id) {
  constexpr std::size_t block = BlockState<Real>::block;
  pinned_.clear();
  if (world_->pins.empty()) return;
  pin_.assign(id.size(), no_pin);
  std::vector<std::uint32_t> of_id(body_->rest.size(), no_pin);
  for (std::uint32_t pin = 0; pin < world_->pins.size(); ++pin)
    of_id[world_->pins[pin].particle] = pin;
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

namespace {

/// Lets a particle slide across.
template <class Real>
void hold_obliquely(const Pinned& pin, std::size_t k, const PinPose& place, BlockState<Real>& state,
                    const Units& units) {
  const Vec3 x = state.position(k, units), v = state.velocity(k, units);
  state.set_position(k, x + held_part(pin, place.position - x), units);
  state.set_velocity(k, v + held_part(pin, place.velocity - v), units);
}

}  // namespace

template <class Real>
void Surroundings<Real>::hold(const Pose& pose, double time, BlockState<Real>& state,
                              const Units& units, std::vector<double>& moved) const {
  if (pinned_.empty()) return;
  const World& world = *world_;
  const std::vector<ObstaclePose> supports = poses_of(world.supports, time, pose);
  parallel_for(pieces_.size(), pieces_per_look, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece)
      for (std::size_t n = first_[piece]; n < first_[piece + 1]; ++n) {
        const std::uint32_t k = pinned_[n];
        const Pinned& pin = world.pins[pin_[k]];
        const PinPose place =
            held_place(pin, body_->rest[pin.particle], world, supports, body_->skeleton, pose);
        const Vec3 before = state.position(k, units);
        for (int axis = 0; axis < 3; ++axis) {
          if (!pin.holds(axis)) continue;
          state.set_position(k, axis, place.position[axis], units);
          state.set_velocity(k, axis, place.velocity[axis], units);
        }
        if (pin.is_oblique()) hold_obliquely(pin, k, place, state, units);
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
  const World& world = *world_;
  // Above rounding.
  const double reach =
      body_->material.pair.r + 1e-5 * (box.diagonal().norm() + body_->material.pair.r);
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
    const RigidFrame& frame = now_.obstacles[k].frame;
    const Vec3 center = frame.rotation.transpose() * (box.center() - frame.origin);
    const Vec3 half = frame.rotation.transpose().cwiseAbs() * box.sizes() / 2;
    const Box local(Vec3(center - half), Vec3(center + half));
    if (may_be_near(world.obstacles[k].shape, local, reach)) return true;
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
  const bool probing = forces_ != nullptr;  // moments of loads are asked for
  for (std::size_t k = first; k < last; ++k) {
    touched_[k] = everywhere_ || (!held_.empty() && held_[k] != 0) ||
                          (probing && loads_.is_on(k)) || (sliding_.any() && has_contacts(k))
                      ? 1
                      : 0;
    if (some && touched_[k] == 0)
      touched_[k] = may_touch(box_of(k * block, std::min((k + 1) * block, state_->size()))) ? 1 : 0;
  }
}

template <class Real>
void Surroundings<Real>::begin(const Pose& pose, double time, BlockState<Real>& state,
                               const Units& units, const VerletLists<Real>& lists, Points* forces) {
  if (!any_) return;
  now_ = world_at(*world_, time, pose);
  state_ = &state;
  pose_ = &pose;
  lists_ = lists.arrays();
  units_ = units;
  forces_ = forces;
  if (forces_ != nullptr) forces_->assign(state.size(), Vec3::Zero());
  loads_.find(now_.loads, state, units_, forces == nullptr);
  parallel_for(pieces_.size(), pieces_per_look, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) {
      pieces_[piece].sums = {};
      pieces_[piece].on_group = none;
      pieces_[piece].reactions.assign(world_->obstacles.size(), {});
      const bool pins = pins_on_bones_ && first_[piece] < first_[piece + 1];
      pieces_[piece].of_pins.assign(pins ? body_->skeleton.size() : 0, {});
      pieces_[piece].support_reactions.assign(world_->supports.size(), {});
      pieces_[piece].load_reactions.assign(loads_.size(), {});
      find_touched(piece, lists.box_of(piece, units_));
    }
  });
}

template <class Real>
bool Surroundings<Real>::has_contacts(std::size_t block) const {
  const std::uint32_t* first =
      lists_[block / kernel::blocks_per_piece].first + block % kernel::blocks_per_piece;
  return first[0] != first[1];
}

/// Sums the friction of what its block's list has within 2r.
template <class Real>
Vec3 Surroundings<Real>::friction_on(std::size_t k, const Vec3& position, const Vec3& velocity) {
  constexpr std::size_t block = BlockState<Real>::block;
  const kernel::Lists& lists = lists_[k / block / kernel::blocks_per_piece];
  const std::uint32_t* first = lists.first + k / block % kernel::blocks_per_piece;
  const Material& material = body_->material;
  std::vector<Touch> touches;
  for (std::uint32_t n = first[0]; n != first[1]; ++n) {
    const std::size_t j = k + static_cast<std::size_t>(lists.value[n]);
    if ((lists.lanes[n] >> k % block & 1) == 0 || j >= state_->size()) continue;
    const Vec3 apart = position - state_->position(j, units_);
    const double d = apart.norm();
    if (!(d < 2 * material.pair.r) || d == 0 || !sliding_.rub(id_[k], id_[j])) continue;
    touches.push_back({id_[j], apart / d, law_of(material).force(material, d),
                       velocity - state_->velocity(j, units_)});
  }
  if (touches.empty() && forces_ != nullptr) return Vec3::Zero();
  return sliding_.force(id_[k], touches, stepping_.step, forces_ == nullptr);
}

/// `unheld`: all forces that pins and supports answer, N.
template <class Real>
void Surroundings<Real>::answer_of_pins(std::size_t k, const PinPose& at, const Vec3& unheld,
                                        const Vec3& middle, Piece& piece) const {
  const Pinned& pin = world_->pins[pin_[k]];
  const Vec3 own = held_part(pin, middle);
  piece.sums.power -= unheld.dot(own);
  piece.sums.held_kinetic += mass_at(k) / 2 * own.squaredNorm();
  if (pin.is_pin())
    add_reaction(pin, at, unheld, *pose_, piece.of_pins);
  else
    add_answer(pin, at, -unheld, now_.supports, piece.support_reactions);
}

/// What the kernel finds on the touched blocks of a piece, and what becomes of it.
template <class Real>
struct Surroundings<Real>::Rows {
  static constexpr std::size_t count = kernel::blocks_per_piece * BlockState<Real>::block;

  std::array<std::array<Real, count>, 3> acceleration;
  std::array<Real, count> held;
  Lines<std::uint8_t> kept;

  kernel::Surroundings<Real> of(const std::uint8_t* touched) {
    return {touched,
            false,
            {acceleration[0].data(), acceleration[1].data(), acceleration[2].data()},
            held.data(),
            kept.data()};
  }
};

template <class Real>
bool Surroundings<Real>::acts_on(const kernel::Step<Real>& step, std::size_t block) {
  return step.surroundings.touched[block] != 0 &&
         (step.grouped.role == nullptr || step.grouped.role[block] != kernel::idle);
}

template <class Real>
void Surroundings<Real>::run(kernel::Work<Real> work, const kernel::Step<Real>& step,
                             std::size_t begin, std::size_t end) {
  if (!any_) return work(step, begin, end);
  static thread_local Rows rows;  // memory of the thread, used within one piece
  if (rows.kept.size() < kept_) rows.kept.resize(kept_);
  kernel::Step<Real> own = step;
  own.surroundings = rows.of(touched_.data());
  for (std::size_t piece = begin; piece < end; ++piece) {
    const std::size_t first = piece * kernel::blocks_per_piece;
    const std::size_t last = std::min(first + kernel::blocks_per_piece, touched_.size());
    bool some = false;
    for (std::size_t block = first; block < last && !some; ++block) some = acts_on(own, block);
    if (some) {
      own.surroundings.finding = true;
      work(own, piece, piece + 1);
      own.surroundings.finding = false;
      act(own, piece, rows);
    }
    work(own, piece, piece + 1);
  }
}

template <class Real>
void Surroundings<Real>::act(const kernel::Step<Real>& step, std::size_t piece, Rows& rows) {
  constexpr std::size_t block_size = BlockState<Real>::block;
  const double unit = units_.length / (units_.time * units_.time);
  const std::size_t begin = piece * Rows::count;
  for (std::size_t row = 0; row < Rows::count; ++row) {
    rows.held[row] = 0;
    const std::size_t k = begin + row;
    if (k >= state_->size() || !acts_on(step, k / block_size)) continue;
    auto& [x, y, z] = rows.acceleration;
    const Vec3 before = unit * Vec3(x[row], y[row], z[row]);
    Vec3 after = before;
    act_on(k, after, rows.held[row]);
    if (after == before) continue;  // not even rounded
    for (int axis = 0; axis < 3; ++axis)
      rows.acceleration[static_cast<std::size_t>(axis)][row] =
          static_cast<Real>(after[axis] / unit);
  }
}

/// Returns the obstacle that presses a particle of a group, or none.
template <class Real>
std::size_t Surroundings<Real>::presses_group(const ParticleState& particle) const {
  if (!body_->grouping || body_->grouping->group[particle.id] < 0) return none;
  for (std::size_t k = 0; k < world_->obstacles.size(); ++k)
    if (contact(world_->obstacles[k], now_.obstacles[k], particle.position, particle.velocity,
                particle.radius)
            .pressing > 0)
      return k;
  return none;
}

template <class Real>
void Surroundings<Real>::refuse_contact_of_groups() const {
  for (const Piece& piece : pieces_)
    if (piece.on_group != none)
      throw Error(Exit::unstable,
                  "obstacle '" + world_->obstacles[piece.on_group].name +
                      "' reached a group of particles, which does not yield where it is pressed; "
                      "free what it presses by hierarchy.free_region, free_bones or "
                      "surface_distance, or set hierarchy.enabled to false");
}

/// Pins and supports take what all other forces leave.
template <class Real>
void Surroundings<Real>::act_on(std::size_t k, Vec3& acceleration, Real& held) {
  const Vec3 position = state_->position(k, units_), velocity = state_->velocity(k, units_);
  const ParticleState particle{
      {}, position, velocity, body_->material.pair.r, static_cast<std::size_t>(id_[k])};
  Piece& piece = pieces_[k / (kernel::blocks_per_piece * BlockState<Real>::block)];
  const double mass = mass_at(k);
  const Vec3 inner = mass * acceleration;  // loads included
  const Vec3 friction = sliding_.any() ? friction_on(k, position, velocity) : Vec3(Vec3::Zero());
  const Vec3 others = inner + friction;
  ParticleWorld world;
  if (acts_in_space_)
    world = world_on(particle, mass, *world_, now_, others, stepping_.step, piece.reactions);
  if (piece.on_group == none && !world.contact.isZero(0)) piece.on_group = presses_group(particle);
  const Vec3 given = friction + world.force();
  const Pinned* pin = is_held(k) ? &world_->pins[pin_[k]] : nullptr;
  acceleration += given / mass;
  if (pin != nullptr) acceleration -= held_part(*pin, acceleration);
  held = pin != nullptr ? Real(1) : Real(0);
  const Vec3 middle = velocity + until_middle_ * acceleration;
  WorldSums& sums = piece.sums;
  sums.power += world.power + world.field.dot(middle);
  sums.lost += world.losing_power - world.losing.dot(middle) - friction.dot(middle);
  sums.contact_energy += world.contact_energy;
  if (acts_in_space_) sums.applied += world.force().norm();
  if (pin != nullptr && pin->is_pin()) sums.applied += (others + world.force()).norm() / 2;
  if (forces_ != nullptr) loads_.add(k, position, middle, piece.load_reactions);
  if (pin != nullptr)
    answer_of_pins(k, {position, velocity}, others + world.force(), middle, piece);
  if (forces_ == nullptr) return;
  const Vec3 load = loads_.force(k);
  Vec3& stored = (*forces_)[k] = load + given;
  if (pin != nullptr) stored = stored - held_part(*pin, given) - held_part(*pin, inner);
}

template <class Real>
WorldSums Surroundings<Real>::sums() const {
  WorldSums all;
  for (const Piece& piece : pieces_)
    for (const auto sum : {&WorldSums::power, &WorldSums::lost, &WorldSums::contact_energy,
                           &WorldSums::held_kinetic, &WorldSums::applied})
      all.*sum += piece.sums.*sum;
  return all;
}

template <class Real>
std::vector<Reaction> Surroundings<Real>::sums_of(std::vector<Reaction> Piece::*part,
                                                  std::size_t count) const {
  std::vector<Reaction> all(any_ ? count : 0);
  for (const Piece& piece : pieces_)
    for (std::size_t k = 0; k < std::min(all.size(), (piece.*part).size()); ++k)
      all[k] += (piece.*part)[k];
  return all;
}

template <class Real>
std::vector<Reaction> Surroundings<Real>::reactions() const {
  return sums_of(&Piece::reactions, any_ ? world_->obstacles.size() : 0);
}

template <class Real>
std::vector<Reaction> Surroundings<Real>::reactions_of_pins() const {
  return sums_of(&Piece::of_pins, pins_on_bones_ ? body_->skeleton.size() : 0);
}

template <class Real>
std::vector<Reaction> Surroundings<Real>::support_reactions() const {
  return sums_of(&Piece::support_reactions, any_ ? world_->supports.size() : 0);
}

template <class Real>
std::vector<Reaction> Surroundings<Real>::load_reactions() const {
  return sums_of(&Piece::load_reactions, loads_.size());
}

template class Surroundings<double>;
template class Surroundings<float>;

}  // namespace sinew
