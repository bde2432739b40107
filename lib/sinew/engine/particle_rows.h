// SPDX-License-Identifier: GPL-3.0-or-later
// All that is constant of a particle as one row of numbers, which an engine of many processes moves
// about with the particle: its place at rest, its bones and its bonds.
//
//     const ParticleRow row(numbers, shape);
//     for (int k = 0; k < row.bones(); ++k) pull(row.influence(k));
#pragma once

#include <cstddef>
#include <cstdint>

#include <sinew/core/vector.h>
#include <sinew/material/pair_force.h>
#include <sinew/rig/binding.h>

namespace sinew {

/// How many bones and bonds of a particle a row has room for; a pair of nearest or of second
/// neighbors is in the rows of both.
struct RowShape {
  std::int32_t bones = 0, nearest = 0, second = 0;

  static constexpr std::size_t head = 7, of_bone = 3, of_bond = 3;
  std::size_t size() const {
    return head + of_bone * static_cast<std::size_t>(bones) +
           of_bond * static_cast<std::size_t>(nearest + second);
  }
};

/// Numbers of a row: place at rest (3), how many bones, nearest and second bonds, how stiffly it
/// keeps its volume, the bones, the bonds to nearest neighbors, those to second ones.
class ParticleRow {
 public:
  ParticleRow(const double* numbers, const RowShape& shape) : numbers_(numbers), shape_(shape) {}

  struct Bond {
    std::int32_t partner;  ///< its id
    BondSpring spring;
  };

  Vec3 rest() const { return {numbers_[0], numbers_[1], numbers_[2]}; }
  int bones() const { return static_cast<int>(numbers_[3]); }
  int nearest() const { return static_cast<int>(numbers_[4]); }
  int second() const { return static_cast<int>(numbers_[5]); }
  int bonds() const { return nearest() + second(); }
  double volume_weight() const { return numbers_[6]; }

  Influence influence(int k) const {
    const double* at = numbers_ + RowShape::head + RowShape::of_bone * static_cast<std::size_t>(k);
    return {static_cast<int>(at[0]), at[1], at[2]};
  }
  /// The first nearest() of them are to nearest neighbors.
  Bond bond(int k) const {
    const double* at = bonds_at(k);
    return {static_cast<std::int32_t>(at[0]), {at[1], at[2]}};
  }
  /// Whether that particle is one of the nearest neighbors at rest.
  bool is_nearest(std::int32_t id) const {
    for (int k = 0; k < nearest(); ++k)
      if (static_cast<std::int32_t>(*bonds_at(k)) == id) return true;
    return false;
  }

 private:
  const double* bonds_at(int k) const {
    return numbers_ + RowShape::head + RowShape::of_bone * static_cast<std::size_t>(shape_.bones) +
           RowShape::of_bond * static_cast<std::size_t>(k);
  }

  const double* numbers_;
  RowShape shape_;
};

}  // namespace sinew
