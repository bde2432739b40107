// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of neighboring particles that move as one: the place of each is an affine function of its
// place X at rest, x = c + F X, or in large groups of bonded bodies a cubic one. What makes them is
// in groups/make_grouping.h.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sinew {

/// Where a particle is in its group. Neighbors may exert forces on those of the rim; those of the
/// shell are neighbors of the rim.
enum class Layer : std::uint8_t { free, rim, shell, core };

struct Grouping {
  std::vector<std::int32_t> group;  ///< one per particle id; -1: free
  std::vector<Layer> layer;         ///< one per particle id
  /// Marks by particle id: 1 within a group where forces are not zero, but follow from its motion.
  std::vector<std::uint8_t> skin;
  /// Half-plane of each particle, by id, counted from the outside of its group, times 6, plus the
  /// side of the group; 0 in cores. Next to each other in memory, those of a face are neighbors of
  /// each other and of the next half-plane's in rows.
  std::vector<std::uint8_t> face;
  std::vector<std::size_t> sizes;   ///< particles of each group
  std::vector<std::uint8_t> cubic;  ///< one per group: 1 where it moves by cubics

  std::size_t size() const { return sizes.size(); }
  /// Returns levels by particle id: 0 free, 1 on the rim, 2 within.
  std::vector<std::int32_t> levels() const;
  std::size_t grouped() const;  ///< particles
  std::size_t inside() const;   ///< number of particles of the shells and cores
};

inline std::size_t Grouping::grouped() const {
  std::size_t count = 0;
  for (const std::size_t size : sizes) count += size;
  return count;
}

inline std::vector<std::int32_t> Grouping::levels() const {
  std::vector<std::int32_t> levels;
  for (const Layer one : layer) levels.push_back(std::min(static_cast<std::int32_t>(one), 2));
  return levels;
}

inline std::size_t Grouping::inside() const {
  return static_cast<std::size_t>(
      std::count_if(layer.begin(), layer.end(), [](Layer one) { return one >= Layer::shell; }));
}

/// The constraint that groups are on the particles of a cell of the body.
struct ConstrainedCell {
  double squares = 0;  ///< sum of squares of accelerations that their groups do not follow, m^2/s^4
  double count = 0;    ///< number of particles
};

}  // namespace sinew
