// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts polygons into triangles (ear clipping) and merges equal points and faces. CGAL's inside test
// is silently wrong on quadrangles.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/core/vector.h>
#include <sinew/mesh/surface.h>

namespace sinew {

// A hash table that finds the first of equal items. Its answers depend on the order of insertion
// alone, not on the hashes.

/// `hash` with another word mixed in.
inline std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9E3779B97F4A7C15ULL;  // 2^64 over the golden ratio
  return hash ^ (hash >> 32);
}

class FirstOf {
 public:
  /// For up to `most` items.
  explicit FirstOf(std::size_t most) : slots_(std::bit_ceil(2 * most + 1), -1) {}

  /// The earliest item for which same(earlier) holds, -1 where there is none. Equal items must have
  /// equal hashes.
  template <class Same>
  int find(std::uint64_t hash, Same&& same) const {
    return slots_[slot_of(hash, same)];
  }

  /// The same, after `item` is added where there was none.
  template <class Same>
  int find_or_add(std::uint64_t hash, int item, Same&& same) {
    int& slot = slots_[slot_of(hash, same)];
    if (slot < 0) slot = item;
    return slot;
  }

 private:
  template <class Same>
  std::size_t slot_of(std::uint64_t hash, Same&& same) const {
    std::size_t slot = hash & (slots_.size() - 1);
    while (slots_[slot] >= 0 && !same(slots_[slot])) slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }

  std::vector<int> slots_;
};

/// The triangles of a polygon (indices into points, 3 corners or more) in the same orientation.
/// Ears are searched in the plane normal to its mean normal; one without area is cut only where no
/// other is left. Throws Error (bad input) for non-convex polygons of more than 1,000 corners.
std::vector<std::array<int, 3>> triangulate(const std::vector<int>& polygon, const Points& points);

/// For each point the one it is merged into: itself, or an earlier one. In their order, each is
/// merged into the earliest kept one that equals it or is closer than `distance` (m; 0 or less:
/// equal ones only), or is kept. So the kept ones are at least that far apart, and no point moves
/// farther than that, however long a chain of close points is.
std::vector<int> first_within(const Points& points, double distance);

/// Triangles that differ in their corners, none collapsed.
struct DistinctFaces {
  Triangles triangles;        ///< on all points of the soup, of which merged ones have no faces
  std::vector<bool> opposed;  ///< per face: others had the same corners in opposite direction
};

/// The first half of clean(). Points closer than `weld` (m) are merged; of faces with the same
/// corners the first is kept. Counts into `counts`.
DistinctFaces distinct_faces(const PolygonSoup& soup, double weld, CleaningCounts& counts);

/// The triangles without points that have no faces; the others keep their order.
Triangles used(const Points& points, std::vector<std::array<int, 3>> faces);

}  // namespace sinew
