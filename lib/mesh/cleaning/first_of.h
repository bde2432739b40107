// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the first of equal items by hash. What it answers depends on the order of the questions
// alone, not on the hashes.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sinew {

/// `hash` with another word mixed in, all bits into all bits.
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

}  // namespace sinew
