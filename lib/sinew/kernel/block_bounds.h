// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of blocks, in floats, and which blocks of some pieces are near one by them.
#pragma once

#include <bit>

#include <sinew/kernel/vectors.h>

namespace sinew::kernel {

/// Coordinates of a piece, by place in the block, then by block. Where there is no particle, one of
/// the same block is, or of the first.
template <class Real>
struct ByPlace {
  float x[3][Traits<Real>::block][blocks_per_piece];

  ByPlace(const State<Real>& state, std::size_t piece, std::size_t particles) {
    constexpr std::size_t size = Traits<Real>::block;
    const std::size_t begin = piece * blocks_per_piece * size;
    for (std::size_t block = 0; block < blocks_per_piece; ++block) {
      const std::size_t own = begin + block * size, first = own < particles ? own : begin;
      for (std::size_t k = 0; k < size; ++k)
        for (int axis = 0; axis < 3; ++axis)
          x[axis][k][block] =
              static_cast<float>(state.x[axis][first + k < particles ? first + k : first]);
    }
  }
};

/// Bounds a vector of blocks, rounded outwards.
template <class L, class Real>
SINEW_INLINE void bound_blocks(const ByPlace<Real>& places, std::size_t first,
                               BlockBounds& bounds) {
  using V = typename L::V;
  V low[bound_axes], high[bound_axes], farthest = L::all(0);
  for (int k = 0; k < Traits<Real>::block; ++k) {
    const V x = L::load(places.x[0][k] + first), y = L::load(places.x[1][k] + first),
            z = L::load(places.x[2][k] + first);
    const V along[bound_axes] = {x, y, z, x + y, x - y, y + z, y - z, z + x, z - x};
    farthest = L::larger(farthest, L::larger(L::size(x), L::larger(L::size(y), L::size(z))));
    for (int axis = 0; axis < bound_axes; ++axis) {
      low[axis] = k == 0 ? along[axis] : L::smaller(along[axis], low[axis]);
      high[axis] = k == 0 ? along[axis] : L::larger(along[axis], high[axis]);
    }
  }
  const V more = L::all(4e-7F) * farthest;
  for (int axis = 0; axis < bound_axes; ++axis) {
    const V scale = L::all(axis < 3 ? 1.0F : 0.70710678F);  // diagonals in lengths
    L::store(bounds.low[axis] + first, scale * low[axis] - more);
    L::store(bounds.high[axis] + first, scale * high[axis] + more);
  }
}

template <class L, class Real>
void bound_piece(const State<Real>& state, std::size_t piece, std::size_t particles,
                 BlockBounds& bounds) {
  const ByPlace<Real> places(state, piece, particles);
  for (std::size_t first = 0; first < blocks_per_piece; first += L::width)
    bound_blocks<L>(places, first, bounds);
}

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

/// The blocks whose particles fill a vector of floats, or one.
template <class L, class Real>
inline constexpr int listed_together =
    L::width > Traits<Real>::block ? L::width / Traits<Real>::block : 1;

/// Finds the blocks of the pieces near `block` and those listed together with it, ascending.
template <class L, class Real>
std::size_t near_blocks(const ListInput<Real>& input, std::size_t block, NearBlock* found) {
  constexpr int together = listed_together<L, Real>;
  const BlockBounds& ones = input.bounds[block / blocks_per_piece];
  NearBlock* end = found;
  const auto for_each_near = [&](const BlockBounds& others, std::size_t first, const auto& visit) {
    std::uint32_t near[together], any = 0;
    for (int n = 0; n < together; ++n) {
      const auto gap = gap_between<L>(ones, block % blocks_per_piece + n, others, first);
      any |= near[n] = L::bits(L::at_most(gap, L::all(input.range)));
    }
    for (; any != 0; any &= any - 1) {
      const int lane = std::countr_zero(any);
      std::uint32_t of = 0;
      for (int n = 0; n < together; ++n) of |= (near[n] >> lane & 1) << n;
      visit(first + static_cast<std::size_t>(lane), of);
    }
  };
  for (std::size_t n = 0; n < input.count; n += L::width) {
    const std::size_t chunk = n / blocks_per_piece;
    for_each_near(input.around[chunk], n % blocks_per_piece, [&](std::size_t which, std::uint32_t) {
      const std::size_t nth = chunk * blocks_per_piece + which;
      for (std::size_t first = 0; first < blocks_per_piece; first += L::width)
        for_each_near(input.bounds[input.pieces[nth]], first,
                      [&](std::size_t other, std::uint32_t of) {
                        *end++ = {static_cast<std::uint32_t>(nth * blocks_per_piece + other), of};
                      });
    });
  }
  return static_cast<std::size_t>(end - found);
}

}  // namespace sinew::kernel
