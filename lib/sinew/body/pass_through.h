// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of bones whose flesh passes through each other: their particles exert no contact on each
// other, nor, in a material that sticks to itself, any attraction. Particles that are near each
// other at rest act as always.
//
//     body.pass_through = PassThrough(body.skeleton.size(), {{hand, thigh}});
//     if (!body.passes(i, j)) force += contact(i, j);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sinew {

class PassThrough {
 public:
  using Pair = std::array<int, 2>;  ///< indices of bones

  PassThrough() = default;
  /// For a skeleton of so many bones; of a pair twice, and of a bone and itself, nothing is kept.
  PassThrough(std::size_t bones, const std::vector<Pair>& pairs);

  bool any() const { return !pairs_.empty(); }
  /// Ascending, the lower bone of each first.
  const std::vector<Pair>& pairs() const { return pairs_; }
  /// Whether a bone is in any of them; bones below 0 are none.
  bool has(int bone) const { return any() && bone >= 0 && has_[static_cast<std::size_t>(bone)]; }
  bool between(int a, int b) const {
    return has(a) && has(b) &&
           passes_[static_cast<std::size_t>(a) * has_.size() + static_cast<std::size_t>(b)];
  }

 private:
  std::vector<Pair> pairs_;
  std::vector<bool> has_;     ///< one per bone
  std::vector<bool> passes_;  ///< bone by bone
};

}  // namespace sinew
