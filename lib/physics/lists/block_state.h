// SPDX-License-Identifier: GPL-3.0-or-later
// Positions and velocities in the kernel's form: whole blocks in an order of their own, with a pad
// of nobody's particles at each end.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/particles.h"
#include "core/simulation_state.h"
#include "physics/kernel/kernel.h"
#include "physics/lists/measure.h"

namespace sinew {

/// a - b as the kernel has it: whole numbers wrap round.
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

  Vec3 position(std::size_t k, const Measure& measure) const;
  void set_position(std::size_t k, const Vec3& p, const Measure& measure);
  Vec3 velocity(std::size_t k, const Measure& measure) const;
  void set_velocity(std::size_t k, const Vec3& v, const Measure& measure);

  MovingColumns<Coord, Real> columns() const;  ///< without the pads
  /// As many as there are.
  void set_columns(const MovingColumns<Coord, Real>& columns);

  /// Puts nobody's particles, far from everything and each other, before the first and after the
  /// last.
  void pad();
  /// The same for the rest of the last block alone, which a step writes.
  void pad_last_block();

 private:
  void pad(std::size_t slot, int number);

  std::size_t size_ = 0;
  std::array<std::vector<Coord>, 3> x_;
  std::array<std::vector<Real>, 3> v_;
};

}  // namespace sinew
