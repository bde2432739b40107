// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the differences of blocks: those of pairs within range. In floats: places are offsets from
// one in the middle.
#pragma once

#include <array>
#include <bit>

#include <sinew/kernel/block_bounds.h>

namespace sinew::kernel {

/// a - b, in the kernel's arithmetic.
SINEW_INLINE float float_offset(double a, double b) { return static_cast<float>(a - b); }
SINEW_INLINE float float_offset(std::int32_t a, std::int32_t b) {
  return static_cast<float>(
      static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b)));
}

// Places of a block, field after field: offsets from the center, and their negative squares.

template <class Real>
void place_block(const ListInput<Real>& input, std::size_t block, float* to) {
  constexpr std::size_t size = Traits<Real>::block;
  for (int axis = 0; axis < 3; ++axis) {
    const Coord<Real>* from = input.state.x[axis] + block * size;
    for (std::size_t k = 0; k < size; ++k)
      to[axis * size + k] = float_offset(from[k], input.center[axis]);
  }
  for (std::size_t k = 0; k < size; ++k) {
    const float x = to[k], y = to[size + k], z = to[2 * size + k];
    to[3 * size + k] = -(x * x + (y * y + z * z));
  }
}

/// The places of blocks near a piece, each found when it is first asked for.
template <class Real>
class Places {
 public:
  static constexpr std::size_t size = Traits<Real>::block;

  explicit Places(const ListInput<Real>& input) : input_(input) {}

  /// Among the blocks of the body.
  std::size_t number(std::size_t near) const {
    return std::size_t{input_.pieces[near / blocks_per_piece]} * blocks_per_piece +
           near % blocks_per_piece;
  }

  const float* of(std::size_t near) const {
    float* places = input_.places + near * 4 * size;
    if (input_.placed[near] == 0) {
      place_block(input_, number(near), places);
      input_.placed[near] = 1;
    }
    return places;
  }

 private:
  const ListInput<Real>& input_;
};

/// Bits of the differences j - i of pairs of some blocks with another one: the first bit is of
/// 1 - size between the particles' places in the blocks.
template <class Real, int together>
struct FoundBits {
  std::uint64_t of[together] = {};
};

/// A line through some particles, and a cylinder about it that holds them: those of a block are few
/// rows of a lattice, wherever these point. Padding is so far away that everything is within.
class Cylinder {
 public:
  Cylinder() = default;
  /// `x`: the fields of particles, of which [begin, end); `reach`: to what is near them.
  Cylinder(const float* const x[3], int begin, int end, float reach) {
    for (int axis = 0; axis < 3; ++axis) {
      center[axis] = 0;
      for (int k = begin; k < end; ++k)
        center[axis] += x[axis][k] / static_cast<float>(end - begin);
    }
    find_direction(x, begin, end);
    float low = 0, high = 0, across2 = 0;
    for (int k = begin; k < end; ++k) {
      const float at[3] = {x[0][k] - center[0], x[1][k] - center[1], x[2][k] - center[2]};
      const float t = product(at, along), off = product(at, at) - t * t;
      low = t < low ? t : low, high = t > high ? t : high;
      across2 = off > across2 ? off : across2;
    }
    const float half = (high - low) / 2 + reach;
    for (int axis = 0; axis < 3; ++axis) center[axis] += (low + high) / 2 * along[axis];
    const float across = root(across2) + reach;
    // All of this is rounded.
    half_length = half * 1.0001F;
    across2_ = across * across * 1.0001F + half * half * 1e-4F;
  }

  /// Whether any of the block of these places may be near.
  template <class L, int size>
  SINEW_INLINE bool meets(const float* places) const {
    std::uint32_t near = 0;
    for (int k = 0; k < size; k += L::width) {
      const auto field = [&](int axis) {
        return L::load(places + axis * size + k) - L::all(center[axis]);
      };
      const Triple<L> at{field(0), field(1), field(2)};
      const typename L::V t = dot<L>(at, {L::all(along[0]), L::all(along[1]), L::all(along[2])});
      const typename L::V off = L::less_fused(t, t, dot<L>(at, at));
      near |= L::bits(L::at_most(L::size(t), L::all(half_length))) &
              L::bits(L::at_most(off, L::all(across2_)));
    }
    return (near & ((std::uint64_t{1} << size) - 1)) != 0;
  }

 private:
  static float product(const float (&a)[3], const float (&b)[3]) {
    return a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]);
  }
  static float root(float value) { return __builtin_sqrtf(value); }

  /// To the particle farthest from the center.
  void find_direction(const float* const x[3], int begin, int end) {
    float most = 0;
    along[0] = 1, along[1] = along[2] = 0;
    for (int k = begin; k < end; ++k) {
      const float at[3] = {x[0][k] - center[0], x[1][k] - center[1], x[2][k] - center[2]};
      const float square = product(at, at);
      if (!(square > most)) continue;
      most = square;
      for (int axis = 0; axis < 3; ++axis) along[axis] = at[axis] / root(square);
    }
  }

  float center[3], along[3], half_length, across2_;
};

/// Around the particles of a block, or of some together. Where a row ends at one side of the body
/// and the next begins at the other one, each has its own.
class Cylinders {
 public:
  Cylinders(const float* const x[3], int count, float reach) {
    float most = reach * reach;  // shorter gaps do not matter
    int split = 0;
    for (int k = 1; k < count; ++k) {
      float square = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const float apart = x[axis][k] - x[axis][k - 1];
        square += apart * apart;
      }
      if (square > most) most = square, split = k;
    }
    one_ = Cylinder(x, split, count, reach);
    if (split > 0) other_ = Cylinder(x, 0, split, reach);
    both_ = split > 0;
  }

  template <class L, int size>
  SINEW_INLINE bool meet(const float* places) const {
    return one_.template meets<L, size>(places) ||
           (both_ && other_.template meets<L, size>(places));
  }

 private:
  Cylinder one_, other_;
  bool both_;
};

/// Blocks in reverse, so that a mask of their particles within range of a particle j is one of
/// differences j - i, ascending. |x_i - x_j|^2 = x_i^2 - 2 x_i x_j + x_j^2 is rounded by less than
/// 16 units in the last place of (|x_i| + |x_j|)^2: the range is longer by as much.
template <class L, class Real>
class Listing {
 public:
  static constexpr int size = Traits<Real>::block, together = listed_together<L, Real>;

  Listing(const Places<Real>& places, std::size_t first, float range)
      : Listing(OwnPlaces(places, first), range) {}

  /// False where there are none: not all of them are computed then.
  SINEW_INLINE bool meets(const float* others) const {
    return cylinders_.template meet<L, size>(others);
  }

  SINEW_INLINE FoundBits<Real, together> differences(const float* others) const {
    constexpr std::uint64_t own = (std::uint64_t{1} << size) - 1;
    FoundBits<Real, together> found;
    for (int k = 0; k < size; ++k) {
      const std::uint64_t lanes = in_range_of(others + k);
      for (int n = 0; n < together; ++n)
        found.of[n] |= (lanes >> (together - 1 - n) * size & own) << k;
    }
    return found;
  }

 private:
  static constexpr int vectors = together * size / L::width, count = together * size;
  using V = typename L::V;

  /// Places of the blocks in reverse, with their squares.
  struct OwnPlaces {
    float x[3][count], square[count], largest = 0;

    OwnPlaces(const Places<Real>& places, std::size_t first) {
      for (int n = 0; n < together; ++n) {
        const float* from = places.of(first + static_cast<std::size_t>(n));
        for (int k = 0; k < size; ++k) {
          const int at = (together - n) * size - 1 - k;
          for (int axis = 0; axis < 3; ++axis) x[axis][at] = from[axis * size + k];
          square[at] = -from[3 * size + k];
          largest = square[at] > largest ? square[at] : largest;
        }
      }
    }

    std::array<const float*, 3> fields() const { return {x[0], x[1], x[2]}; }

    /// Beyond all that rounding may let in.
    float reach(float range) const {
      return __builtin_sqrtf(range * range * (1 + 1e-5F) + largest * 2e-5F);
    }
  };

  Listing(const OwnPlaces& own, float range)
      : cylinders_(own.fields().data(), count, own.reach(range)) {
    const float range2 = range * range * (1 + 2e-6F);
    const V minus_two = L::all(-2), shorter = L::all(1 - 8e-6F), less = L::all(range2);
    for (int n = 0; n < vectors; ++n) {
      x_[n] = minus_two * L::load(own.x[0] + n * L::width);
      y_[n] = minus_two * L::load(own.x[1] + n * L::width);
      z_[n] = minus_two * L::load(own.x[2] + n * L::width);
      square_[n] = shorter * L::load(own.square + n * L::width) - less;
    }
  }

  SINEW_INLINE std::uint64_t in_range_of(const float* place) const {
    const V x = L::all(place[0]), y = L::all(place[size]), z = L::all(place[2 * size]);
    const V minus_square = L::all(place[3 * size]);
    std::uint64_t lanes = 0;
    for (int n = 0; n < vectors; ++n) {
      const V others = L::fused(x_[n], x, L::fused(y_[n], y, L::fused(z_[n], z, square_[n])));
      lanes |= std::uint64_t{L::bits(L::less(others, minus_square))} << (n * L::width);
    }
    return lanes;
  }

  Cylinders cylinders_;
  V x_[vectors], y_[vectors], z_[vectors], square_[vectors];
};

/// Writes the differences of the bits, the first of which is of `from`.
inline std::int32_t* put_differences(std::uint64_t bits, std::int64_t from, std::int32_t* to) {
  for (; bits != 0; bits &= bits - 1)
    *to++ = static_cast<std::int32_t>(from + std::countr_zero(bits));
  return to;
}

/// The list of a block, written as its differences with one block after another are found.
template <class Real>
class BlockList {
 public:
  BlockList(std::size_t block, std::int32_t* to) : block_(block), begin_(to), end_(to) {}

  /// `other` ascends.
  void add(std::size_t other, std::uint64_t bits) {
    if (bits == 0) return;
    if (other != last_ + 1) close();
    const std::uint64_t all = bits | open_;
    put(other, all & low_half);
    open_ = all >> size;
    last_ = other;
  }

  std::size_t close() {
    if (open_ != 0) put(last_ + 1, open_);
    open_ = 0;
    return static_cast<std::size_t>(end_ - begin_);
  }

 private:
  static constexpr int size = Traits<Real>::block;
  static constexpr std::uint64_t low_half = (std::uint64_t{1} << size) - 1;

  void put(std::size_t other, std::uint64_t bits) {
    const std::int64_t apart = static_cast<std::int64_t>(other) - static_cast<std::int64_t>(block_);
    if (apart == 0) bits &= ~(std::uint64_t{1} << (size - 1));  // a particle and itself
    end_ = put_differences(bits, apart * size - (size - 1), end_);
  }

  std::size_t block_;
  std::int32_t *begin_, *end_;
  std::uint64_t open_ = 0;  ///< bits that the next block may have too
  std::size_t last_ = ~std::size_t{1};
};

template <class L, class Real>
SINEW_INLINE void list_together(const ListInput<Real>& input, std::size_t block, NearBlock* near,
                                BlockList<Real>* lists) {
  constexpr int together = listed_together<L, Real>;
  const Places<Real> places(input);
  const Listing<L, Real> listing(places, input.own * blocks_per_piece + block % blocks_per_piece,
                                 input.range);
  const NearBlock* end = near + near_blocks<L>(input, block, near);
  for (; near != end; ++near) {
    const float* others = places.of(near->which);
    if (!listing.meets(others)) continue;
    const auto bits = listing.differences(others);
    for (int n = 0; n < together; ++n)
      if ((near->of >> n & 1) != 0) lists[n].add(places.number(near->which), bits.of[n]);
  }
}

template <class L, class Real>
void list_two(const ListInput<Real>& input, std::size_t block, NearBlock* near,
              std::int32_t* const found[2], std::size_t counts[2]) {
  BlockList<Real> lists[2] = {{block, found[0]}, {block + 1, found[1]}};
  for (int n = 0; n < 2; n += listed_together<L, Real>)
    list_together<L>(input, block + static_cast<std::size_t>(n), near, lists + n);
  for (int n = 0; n < 2; ++n) counts[n] = lists[n].close();
}

}  // namespace sinew::kernel
