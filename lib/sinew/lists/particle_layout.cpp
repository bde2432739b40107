// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/particle_layout.h>

#include <string>
#include <type_traits>
#include <utility>

#include <sinew/core/parallel.h>
#include <sinew/core/simulation_state.h>
#include <sinew/core/triangles.h>
#include <sinew/lists/particle_order.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_conversion = 8192;

Box box_around(const Particles& particles) {
  std::vector<Box> boxes(particles.size() / particles_per_conversion + 1);
  parallel_for(particles.size(), particles_per_conversion, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      boxes[begin / particles_per_conversion].extend(particles.position(i));
  });
  Box box;
  for (const Box& one : boxes) box.extend(one);
  return box;
}

}  // namespace

template <class Real>
ParticleLayout<Real>::ParticleLayout(const Body& body, const Particles& particles, double step)
    : now(particles.size()),
      next(now),
      pair_(body.material.pair),
      step_(step),
      units_box_(box_around(particles)),
      id_((now.blocks() + 2) * block, 0),
      caller_(order_at_rest(body, particles.id)) {
  // In double precision the same for all states of a body, wherever it has gone.
  const bool moves = std::is_same_v<Real, float>;
  units_ = units_for<Real>(moves ? units_box_ : bounds(body.rest), pair_, step_);
  parallel_split(size(), particles_per_conversion, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t i = caller_[k];
      id_[k + block] = particles.id[i];
      now.set_position(k, particles.position(i), units_);
      now.set_velocity(k, particles.velocity(i), units_);
    }
  });
}

template <class Real>
void ParticleLayout<Real>::advance(double travel) {
  std::swap(now, next);
  now.pad_last_block();
  if (sizeof(Real) == 4) traveled_ += travel;
}

template <class Real>
void ParticleLayout<Real>::reorder(std::vector<std::uint32_t>& order) {
  sinew::reorder(now, order, next);
  std::swap(now, next);
  std::vector<std::int32_t> id(id_.size(), 0);
  std::vector<std::uint32_t> caller(caller_.size()), back(order.size());
  parallel_split(order.size(), particles_per_conversion, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      id[k + block] = id_[order[k] + block];
      caller[k] = caller_[order[k]];
      back[order[k]] = static_cast<std::uint32_t>(k);
    }
  });
  id_ = std::move(id);
  caller_ = std::move(caller);
  order = std::move(back);
}

template <class Real>
bool ParticleLayout<Real>::units_are_due() const {
  return sizeof(Real) == 4 && traveled_ > free_travel<Real>(units_);
}

template <class Real>
bool ParticleLayout<Real>::change_units() {
  if (!units_are_due()) return false;
  units_box_ = now.box(units_, particles_per_conversion);
  traveled_ = 0;
  if (covers<Real>(units_, units_box_)) return false;
  const Units before = std::exchange(units_, units_for<Real>(units_box_, pair_, step_));
  parallel_split(size(), particles_per_conversion, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      now.set_velocity(k, now.velocity(k, before), units_);
      now.set_position(k, now.position(k, before), units_);
    }
  });
  return true;
}

template <class Real>
void ParticleLayout<Real>::read(Particles& particles) const {
  for (auto* all :
       {&particles.x, &particles.y, &particles.z, &particles.u, &particles.v, &particles.w})
    all->resize(size());
  parallel_split(size(), particles_per_conversion, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      particles.set_position(caller_[k], now.position(k, units_));
      particles.set_velocity(caller_[k], now.velocity(k, units_));
    }
  });
}

template <class Real>
void ParticleLayout<Real>::save(SimulationState& state) const {
  state.moving = now.columns();
  state.order = caller_;
  state.fixed_point_units = {units_.length, units_.origin, units_box_, traveled_};
}

template <class Real>
void ParticleLayout<Real>::restore(const SimulationState& state) {
  const auto* moving = std::get_if<Columns>(&state.moving);
  if (moving == nullptr) throw not_a_state("it is in another precision");
  check_moving(*moving, size());
  check_places(*moving, state.fixed_point_units);
  restore_order(state.order);
  restore_units(state.fixed_point_units);
  now.set_columns(*moving);
  next = now;
}

/// Lists count from end to end of the body, which a state from elsewhere may have torn apart.
template <class Real>
void ParticleLayout<Real>::check_places(const Columns& moving, const FixedPointUnits& saved) const {
  constexpr double farthest = 1e6, finest = 1e-12;  // multiples of the body's size
  const double size_now = units_box_.diagonal().norm() + pair_.b;
  const Vec3 middle = units_box_.center();
  const bool known = std::is_same_v<Real, double>
                         ? saved.length == units_.length && saved.origin == units_.origin
                         : saved.length > finest * size_now && saved.length < size_now;
  const auto is_near = [&](const Vec3& place) {
    return (place - middle).norm() <= farthest * size_now;
  };
  if (!is_sound(saved) || !known || !is_near(saved.box.min()) || !is_near(saved.box.max()))
    throw not_a_state("its units are none");
  for (std::size_t k = 0; k < size(); ++k) {
    Vec3 place;
    for (int axis = 0; axis < 3; ++axis) place[axis] = static_cast<double>(moving.x[axis][k]);
    if (!is_near(saved.origin + saved.length * place))
      throw not_a_state("particle " + std::to_string(k) + " is far away from the body");
  }
}

/// `order` contains each particle's place in the caller's order once.
template <class Real>
void ParticleLayout<Real>::restore_order(const std::vector<std::uint32_t>& order) {
  std::vector<std::int32_t> id_of(size(), -1);
  for (std::size_t k = 0; k < size(); ++k) id_of[caller_[k]] = id_[k + block];
  if (order.size() != id_of.size()) throw not_a_state("it has no order of the particles");
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (order[k] >= id_of.size() || id_of[order[k]] < 0)
      throw not_a_state("its order of the particles names one twice");
    id_[k + block] = std::exchange(id_of[order[k]], -1);
  }
  caller_ = order;
}

template <class Real>
void ParticleLayout<Real>::restore_units(const FixedPointUnits& saved) {
  units_.length = saved.length;
  units_.origin = saved.origin;
  units_box_ = saved.box;
  traveled_ = saved.traveled;
}

template class ParticleLayout<double>;
template class ParticleLayout<float>;

}  // namespace sinew
