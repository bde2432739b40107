// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the differences of a block: first the pieces and the blocks near it, by bounds, then those
// of pairs within range.
#pragma once

#include <algorithm>
#include <bit>

#include <sinew/physics/kernel/parts.h>

namespace sinew::kernel {

// Blocks near a block.

/// The farthest that bounds are apart along any axis, for a vector of blocks.
template <class L>
SINEW_INLINE typename L::V gap_between(const BlockBounds& one, std::size_t at,
                                       const BlockBounds& others, std::size_t first) {
  typename L::V gap = L::all(0);
  for (int axis = 0; axis < bound_axes; ++axis) {
    const auto above = L::load(others.low[axis] + first) - L::all(one.high[axis][at]);
    const auto below = L::all(one.low[axis][at]) - L::load(others.high[axis] + first);
    gap = L::larger(gap, L::larger(above, below));
  }
  return gap;
}

template <class L>
std::size_t near_blocks(const BlockBounds* bounds, std::size_t block, const SomePieces& pieces,
                        float range, std::uint32_t* found) {
  const BlockBounds& one = bounds[block / blocks_per_piece];
  const std::size_t at = block % blocks_per_piece;
  std::uint32_t* end = found;
  const auto for_each_near = [&](const BlockBounds& others, std::size_t first, const auto& visit) {
    const auto gap = gap_between<L>(one, at, others, first);
    for (std::uint32_t near = L::bits(L::at_most(gap, L::all(range))); near != 0; near &= near - 1)
      visit(first + static_cast<std::size_t>(std::countr_zero(near)));
  };
  for (std::size_t n = 0; n < pieces.count; n += L::width) {
    const std::size_t chunk = n / blocks_per_piece;
    for_each_near(pieces.around[chunk], n % blocks_per_piece, [&](std::size_t which) {
      const std::size_t piece = pieces.number[chunk * blocks_per_piece + which];
      for (std::size_t first = 0; first < blocks_per_piece; first += L::width)
        for_each_near(bounds[piece], first, [&](std::size_t other) {
          *end++ = static_cast<std::uint32_t>(piece * blocks_per_piece + other);
        });
    });
  }
  return static_cast<std::size_t>(end - found);
}

// Differences of their pairs.

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
    find_bounds();
  }

  /// Bits of the differences j - i that have a pair within range, j in block `other`: the first is
  /// of -(size - 1) between their places in the blocks.
  std::uint64_t differences(std::size_t other) const {
    const auto first = static_cast<std::ptrdiff_t>(other * size);
    std::uint64_t found = 0;
    for (int lane = 0; lane < size; lane += L::width)
      for (std::uint32_t near = near_bounds(first + lane); near != 0; near &= near - 1) {
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

  /// Along the axes of bounds, the diagonals not divided by the root of 2.
  static void along_axes(const Triple<L>& at, typename L::V (&along)[bound_axes]) {
    const typename L::V all[bound_axes] = {at.x,        at.y,        at.z,
                                           at.x + at.y, at.x - at.y, at.y + at.z,
                                           at.y - at.z, at.z + at.x, at.z - at.x};
    for (int axis = 0; axis < bound_axes; ++axis) along[axis] = all[axis];
  }

  /// Around the block, of offsets from its first particle.
  void find_bounds() {
    typename L::V lows[bound_axes], highs[bound_axes], along[bound_axes];
    for (int axis = 0; axis < bound_axes; ++axis) lows[axis] = highs[axis] = L::all(0);
    for (int k = 0; k < size; k += L::width) {
      along_axes(offset<L>(reversed(k), first()), along);
      for (int axis = 0; axis < bound_axes; ++axis) {
        lows[axis] = L::smaller(along[axis], lows[axis]);
        highs[axis] = L::larger(along[axis], highs[axis]);
      }
    }
    for (int axis = 0; axis < bound_axes; ++axis) {
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

  SINEW_INLINE typename L::V gap(int axis, typename L::V x) const {
    return L::larger(L::larger(L::all(low_[axis]) - x, x - L::all(high_[axis])), L::all(0));
  }

  /// Lanes within range of the bounds.
  std::uint32_t near_bounds(std::ptrdiff_t j) const {
    typename L::V along[bound_axes];
    along_axes(offset<L>(load_place<L>(input_.state.x, j), first()), along);
    const Triple<L> gaps{gap(0, along[0]), gap(1, along[1]), gap(2, along[2])};
    typename L::V diagonal = gap(3, along[3]);
    for (int axis = 4; axis < bound_axes; ++axis)
      diagonal = L::larger(diagonal, gap(axis, along[axis]));
    const typename L::V half = L::all(static_cast<Real>(0.5)) * diagonal * diagonal;
    const Real range2 = input_.range2 * static_cast<Real>(1 + 1e-5);
    return L::bits(L::at_most(L::larger(squared_distance<L>(gaps), half), L::all(range2)));
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
  Real low_[bound_axes], high_[bound_axes];  ///< of offsets from the first particle
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
