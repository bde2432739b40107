// SPDX-License-Identifier: GPL-3.0-or-later
// Selects the differences of a block that belong in its list: those with a pair within range.
#pragma once

#include <algorithm>
#include <bit>

#include <sinew/physics/kernel/parts.h>

namespace sinew::kernel {

template <class L>
struct BlockPlaces {
  Place<L> here[Traits<typename L::Real>::block / L::width];

  SINEW_INLINE BlockPlaces(const PruneInput<typename L::Real>& input, std::size_t block) {
    const auto i = static_cast<std::ptrdiff_t>(block * Traits<typename L::Real>::block);
    for (int k = 0; k < Traits<typename L::Real>::block / L::width; ++k)
      here[k] = load_place<L>(input.state.x, i + k * L::width);
  }
};

/// Whether a pair of the lanes is within range; `masked`: not of all of them.
template <class L, bool masked>
SINEW_INLINE bool meets(const PruneInput<typename L::Real>& input, const BlockPlaces<L>& places,
                        std::size_t block, std::ptrdiff_t difference, std::uint32_t lanes) {
  constexpr int size = Traits<typename L::Real>::block;
  const typename L::V range2 = L::all(input.range2);
  const std::ptrdiff_t j = static_cast<std::ptrdiff_t>(block) * size + difference;
  bool found = false;
  for (int k = 0; k < size / L::width; ++k) {
    const Place<L> there = load_place<L>(input.state.x, j + k * L::width);
    typename L::V squared = squared_distance<L>(offset<L>(places.here[k], there));
    if constexpr (masked) squared = L::pick(L::mask(lanes >> (k * L::width)), squared, range2);
    found |= L::any(L::less(squared, range2));
  }
  return found;
}

template <class L>
std::size_t prune_list(const PruneInput<typename L::Real>& input, std::size_t block,
                       const Candidates& from, const Candidates& kept) {
  const BlockPlaces<L> places(input, block);
  std::size_t count = 0;
  if (from.lanes == nullptr) {
    for (std::size_t n = 0; n < from.count; ++n) {
      kept.value[count] = from.value[n];
      count += meets<L, false>(input, places, block, from.value[n], 0);
    }
    return count;
  }
  for (std::size_t n = 0; n < from.count; ++n) {
    kept.value[count] = from.value[n];
    kept.lanes[count] = from.lanes[n];
    count += meets<L, true>(input, places, block, from.value[n], from.lanes[n]);
  }
  return count;
}

// Candidates from other blocks.

/// A block's particles in reverse, so that a mask of those within range of a particle j is one of
/// differences j - i, ascending.
template <class L>
class Listing {
 public:
  using Real = typename L::Real;
  static constexpr int size = Traits<Real>::block;

  Listing(const PruneInput<Real>& input, std::size_t block) : input_(input) {
    const std::size_t first = block * size;
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k < size; ++k)
        reversed_[axis][size - 1 - k] = input.state.x[axis][first + static_cast<std::size_t>(k)];
      first_[axis] = reversed_[axis][size - 1];
    }
    find_box();
  }

  /// Bits of the differences j - i that have a pair within range, j in block `other`: the first is
  /// of -(size - 1) between their places in the blocks.
  std::uint64_t differences(std::size_t other) const {
    const auto first = static_cast<std::ptrdiff_t>(other * size);
    std::uint64_t found = 0;
    for (int lane = 0; lane < size; lane += L::width)
      for (std::uint32_t near = near_box(first + lane); near != 0; near &= near - 1) {
        const int place = lane + std::countr_zero(near);
        found |= in_range_of(first + place) << place;
      }
    return found;
  }

 private:
  using Coord = typename L::Coord;

  /// No padding, from which offsets would wrap around.
  Place<L> first() const {
    return {L::all_coord(first_[0]), L::all_coord(first_[1]), L::all_coord(first_[2])};
  }

  /// Around the block, of offsets from its first particle.
  void find_box() {
    Triple<L> low = none<L>(), high = low;
    for (int k = 0; k < size; k += L::width) {
      const Triple<L> at = offset<L>(reversed(k), first());
      low = {L::smaller(at.x, low.x), L::smaller(at.y, low.y), L::smaller(at.z, low.z)};
      high = {L::larger(at.x, high.x), L::larger(at.y, high.y), L::larger(at.z, high.z)};
    }
    const typename L::V lows[3] = {low.x, low.y, low.z}, highs[3] = {high.x, high.y, high.z};
    for (int axis = 0; axis < 3; ++axis) {
      Real least[L::width], most[L::width];
      L::store(least, lows[axis]), L::store(most, highs[axis]);
      low_[axis] = *std::min_element(least, least + L::width);
      high_[axis] = *std::max_element(most, most + L::width);
      // Offsets are rounded.
      const Real more = (high_[axis] - low_[axis]) * static_cast<Real>(1e-5);
      low_[axis] -= more, high_[axis] += more;
    }
  }

  Place<L> reversed(int k) const {
    return {L::load_coord(reversed_[0] + k), L::load_coord(reversed_[1] + k),
            L::load_coord(reversed_[2] + k)};
  }

  static typename L::V gap(typename L::V x, Real low, Real high) {
    return L::larger(L::larger(L::all(low) - x, x - L::all(high)), L::all(0));
  }

  /// Lanes within range of the box.
  std::uint32_t near_box(std::ptrdiff_t j) const {
    const Triple<L> at = offset<L>(load_place<L>(input_.state.x, j), first());
    const Triple<L> gaps{gap(at.x, low_[0], high_[0]), gap(at.y, low_[1], high_[1]),
                         gap(at.z, low_[2], high_[2])};
    const Real range2 = input_.range2 * static_cast<Real>(1 + 1e-5);
    return L::bits(L::at_most(squared_distance<L>(gaps), L::all(range2)));
  }

  std::uint64_t in_range_of(std::ptrdiff_t j) const {
    const Place<L> there{L::all_coord(input_.state.x[0][j]), L::all_coord(input_.state.x[1][j]),
                         L::all_coord(input_.state.x[2][j])};
    std::uint64_t lanes = 0;
    for (int k = 0; k < size; k += L::width) {
      const typename L::V squared = squared_distance<L>(offset<L>(reversed(k), there));
      lanes |= std::uint64_t{L::bits(L::less(squared, L::all(input_.range2)))} << k;
    }
    return lanes;
  }

  PruneInput<Real> input_;
  Coord reversed_[3][size], first_[3];
  Real low_[3], high_[3];  ///< of offsets from the first particle
};

/// Writes the differences of the bits, the first of which is of `from`.
inline std::int32_t* put_differences(std::uint64_t bits, std::int64_t from, std::int32_t* to) {
  for (; bits != 0; bits &= bits - 1)
    *to++ = static_cast<std::int32_t>(from + std::countr_zero(bits));
  return to;
}

template <class L>
std::size_t list_block(const PruneInput<typename L::Real>& input, std::size_t block,
                       const std::uint32_t* others, std::size_t count, std::int32_t* found) {
  constexpr int size = Traits<typename L::Real>::block;
  constexpr std::uint64_t low_half = (std::uint64_t{1} << size) - 1;
  const Listing<L> listing(input, block);
  std::int32_t* end = found;
  std::uint64_t open = 0;  // of the block before, those that the next one may have too
  for (std::size_t k = 0; k < count; ++k) {
    const std::int64_t first =
        (static_cast<std::int64_t>(others[k]) - static_cast<std::int64_t>(block)) * size -
        (size - 1);
    std::uint64_t bits = listing.differences(others[k]) | open;
    if (others[k] == block) bits &= ~(std::uint64_t{1} << (size - 1));  // a particle and itself
    const bool followed = k + 1 < count && others[k + 1] == others[k] + 1;
    end = put_differences(followed ? bits & low_half : bits, first, end);
    open = followed ? bits >> size : 0;
  }
  return static_cast<std::size_t>(end - found);
}

}  // namespace sinew::kernel
