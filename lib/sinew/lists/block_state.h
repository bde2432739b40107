// SPDX-License-Identifier: GPL-3.0-or-later
// Positions and velocities in the kernel's layout: whole blocks in an order of their own, with a
// block of padding particles at each end.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <sinew/core/lines.h>
#include <sinew/core/particles.h>
#include <sinew/core/simulation_state.h>
#include <sinew/core/vector.h>
#include <sinew/kernel/kernel.h>
#include <sinew/material/pair_force.h>

namespace sinew {

// The kernel's units, positions included.

/// The kernel's units. Double precision uses meters, from a local origin, and seconds. Single
/// precision counts time in steps and stores positions as fixed-point numbers: multiples of a small
/// length from an origin.
struct Units {
  double length = 1;  ///< m
  double time = 1;    ///< s
  Vec3 origin = Vec3::Zero();

  double acceleration(double si) const { return si * time * time / length; }
  double velocity(double si) const { return si * time / length; }
};

/// The units for particles within `box` (m) that take steps of `step` (s).
template <class Real>
Units units_for(const Box& box, const PairForce& pair, double step);

/// Whether the units still cover particles within `box` (m): fixed-point numbers have a limited
/// range, and a body may have grown or moved far since.
template <class Real>
bool covers(const Units& units, const Box& box);

/// How far particles may travel before the units are checked again, m.
template <class Real>
double free_travel(const Units& units);

/// Whether units that were saved are finite and positive where they have to be.
bool is_sound(const FixedPointUnits& saved);

/// Eq. 1 and the damping constant (kg/s) in these units, per particle `mass` (kg).
template <class Real>
kernel::Law<Real> law_in(const Units& units, const PairForce& pair, double damping, double mass);

/// a - b in the kernel's arithmetic: integers wrap around.
inline double difference_of(double a, double b) { return a - b; }
inline std::int32_t difference_of(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

template <class Real>
class BlockState {
 public:
  using Coord = typename kernel::Traits<Real>::Coord;
  static constexpr int block = kernel::Traits<Real>::block;

  BlockState() = default;
  explicit BlockState(std::size_t particles);

  std::size_t size() const { return size_; }
  std::size_t blocks() const { return (size_ + block - 1) / block; }
  /// Pointers to the first particle; one block before it and one after the last may be read.
  kernel::State<Real> arrays();

  /// Marks by lane of the last block: 1 for a particle, 0 for padding.
  const Real* live() const { return live_.data(); }

  Vec3 position(std::size_t k, const Units& units) const;
  void set_position(std::size_t k, const Vec3& p, const Units& units);
  void set_position(std::size_t k, int axis, double p, const Units& units);
  Vec3 velocity(std::size_t k, const Units& units) const;
  void set_velocity(std::size_t k, const Vec3& v, const Units& units);
  void set_velocity(std::size_t k, int axis, double v, const Units& units);

  void halt();  ///< all velocities become 0

  /// Around the particles, m; `grain`: of them a thread takes at a time.
  Box box(const Units& units, std::size_t grain) const;

  MovingColumns<Coord, Real> columns() const;  ///< without the pads
  /// Takes as many as there are particles.
  void set_columns(const MovingColumns<Coord, Real>& columns);

  /// Puts padding particles, far from everything and from each other, before the first and after
  /// the last particle.
  void pad();
  /// The same for the rest of the last block only, which a step overwrites.
  void pad_last_block();

 private:
  void pad(std::size_t slot, int number);

  std::size_t size_ = 0;
  std::array<Real, block> live_{};
  std::array<Lines<Coord>, 3> x_;
  std::array<Lines<Real>, 3> v_;
};

}  // namespace sinew
