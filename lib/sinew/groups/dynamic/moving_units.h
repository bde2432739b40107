// SPDX-License-Identifier: GPL-3.0-or-later
// What may join groups: units, the particles of one cell of the body that follow one assembly of
// its skeleton; and how they move.
//
//     const MovingUnits units(body, cells, assemblies, group, particles);
//     const AffineMap& map = units.all()[u].map;
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/core/particles.h>
#include <sinew/groups/bone_assemblies.h>
#include <sinew/groups/cubic/cubic_fits.h>

namespace sinew {

/// x = c + F (X - center), and its rate.
struct AffineMap {
  Vec3 center = Vec3::Zero(), c = Vec3::Zero(), v = Vec3::Zero();
  Mat3 F = Mat3::Identity(), V = Mat3::Zero();
};

/// Over particles, of places that are near the origin.
struct AffineSums {
  double n = 0;
  Vec3 X = Vec3::Zero(), x = Vec3::Zero(), v = Vec3::Zero();
  Mat3 XX = Mat3::Zero(), xX = Mat3::Zero(), vX = Mat3::Zero();

  void add(const Vec3& rest, const Vec3& at, const Vec3& velocity);
  AffineSums& operator+=(const AffineSums& other);
  Mat3 spread() const { return XX - X * X.transpose() / n; }
  /// Fits by least squares.
  AffineMap map() const;
};

struct Unit {
  std::int32_t cell = 0;
  int assembly = -1;
  std::int32_t group = -1;   ///< group that it joins
  std::int32_t was_in = -1;  ///< group of all of its particles; -1: none
  bool fits = true;
  AffineSums sums;
  AffineMap map;
  Residual own;  ///< residual from its map

  bool was_grouped() const { return was_in >= 0; }
  /// Returns how far it is from another map.
  Residual from(const AffineMap& other) const;
};

class MovingUnits {
 public:
  /// In the order of their cells and assemblies. `cell`: of each particle, by id; `group`: what is
  /// in one is in no unit. `particles`: at the moment, in any order.
  MovingUnits(const Body& body, std::span<const std::int32_t> cell,
              const BoneAssemblies& assemblies, std::span<const std::int32_t> group,
              const Particles& particles);

  std::vector<Unit>& all() { return units_; }
  /// The ids of a unit's particles, ascending.
  std::span<const std::uint32_t> members(std::size_t unit) const {
    return {member_.data() + first_[unit], first_[unit + 1] - first_[unit]};
  }
  /// Sums over some units, in a frame for the places of their particles. In parallel.
  std::vector<CubicSums> cubic_sums(std::span<const std::size_t> units) const;

 private:
  void find(std::span<const std::int32_t> cell, const BoneAssemblies& assemblies,
            std::span<const std::int32_t> group);
  void measure(Unit& unit, std::span<const std::uint32_t> members) const;

  const Body& body_;
  const Particles& particles_;
  std::vector<std::uint32_t> place_;  ///< in the particles, by id
  std::vector<Unit> units_;
  std::vector<std::uint32_t> first_, member_;
};

}  // namespace sinew
