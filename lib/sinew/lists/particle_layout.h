// SPDX-License-Identifier: GPL-3.0-or-later
// The particles of a simulation in the kernel's layout: their order, their units, and their states
// before and after a step.
//
//     ParticleLayout<Real> layout(body, particles, step);
//     ... a step from layout.now to layout.next ...
//     layout.advance(travel);
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/lists/block_state.h>

namespace sinew {

template <class Real>
class ParticleLayout {
 public:
  static constexpr int block = BlockState<Real>::block;

  ParticleLayout() = default;
  /// For steps of `step` (s).
  ParticleLayout(const Body& body, const Particles& particles, double step);

  std::size_t size() const { return caller_.size(); }
  const Units& units() const { return units_; }
  /// Returns ids of particles in the kernel's order, a block of zeros at each end.
  std::span<const std::int32_t> id() const { return {id_.data() + block, size()}; }
  const std::int32_t* padded_id() const { return id_.data() + block; }
  /// Their places in the caller's order.
  const std::vector<std::uint32_t>& caller() const { return caller_; }

  /// The state after the step becomes that before the next one. `travel`: how far particles have
  /// moved, at most, m.
  void advance(double travel);
  /// Particle order[k] becomes the k-th one; `order` then leads back.
  void reorder(std::vector<std::uint32_t>& order);
  /// Whether the next check may choose other units, so that it reads all positions.
  bool units_are_due() const;
  /// Chooses other units where the body may have left the range of the present ones, and has.
  bool change_units();
  void read(Particles& particles) const;

  void save(SimulationState& state) const;
  /// Throws bad input where the state is not of these particles.
  void restore(const SimulationState& state);

  BlockState<Real> now, next;

 private:
  using Columns = MovingColumns<typename BlockState<Real>::Coord, Real>;

  void restore_order(const std::vector<std::uint32_t>& order);
  void restore_units(const FixedPointUnits& saved);
  void check_places(const Columns& moving, const FixedPointUnits& saved) const;

  PairForce pair_;
  double step_ = 0;  ///< s
  Units units_;
  Box units_box_;        ///< around the particles when the units were last checked, m
  double traveled_ = 0;  ///< upper bound for any particle since then, m
  std::vector<std::int32_t> id_;
  std::vector<std::uint32_t> caller_;
};

}  // namespace sinew
