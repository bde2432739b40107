// SPDX-License-Identifier: GPL-3.0-or-later
// Where the polynomials by which groups move bring their particles.
#pragma once

#include <cstdint>

#include <sinew/kernel/vectors.h>

namespace sinew::kernel {

/// A polynomial's values, with coefficients in the order of groups/cubic/polynomials.h.
template <class L, int terms>
SINEW_INLINE typename L::V polynomial(const double* c, const Triple<L>& at) {
  using V = typename L::V;
  const auto all = [&](int k) __attribute__((always_inline)) { return L::all(c[k]); };
  const auto add = [](V a, V t, V b) __attribute__((always_inline)) { return L::fused(a, t, b); };
  const V x = at.x, y = at.y, z = at.z;
  if constexpr (terms == affine_terms) {
    return add(z, all(3), add(y, all(2), add(x, all(1), all(0))));
  } else {
    const V xx = add(x, all(10), add(y, all(11), add(z, all(12), all(4))));
    const V xy = add(y, all(13), add(z, all(14), all(5))), xz = add(z, all(15), all(6));
    const V of_x = add(x, xx, add(y, xy, add(z, xz, all(1))));
    const V yy = add(y, all(16), add(z, all(17), all(7))), yz = add(z, all(18), all(8));
    const V of_y = add(y, yy, add(z, yz, all(2)));
    const V of_z = add(z, add(z, all(19), all(9)), all(3));
    return add(x, of_x, add(y, of_y, add(z, of_z, all(0))));
  }
}

/// Calls visit(k, place) for vectors of the particles [begin, end), the last of which overlaps the
/// one before. False where there are too few.
template <class L, class Visit>
SINEW_INLINE bool for_each_place(const double* const at[3], std::size_t begin, std::size_t end,
                                 Visit&& visit) {
  if (end - begin < L::width) return false;
  for (std::size_t next = begin; next < end; next += L::width) {
    const std::size_t k = next + L::width <= end ? next : end - L::width;
    visit(k, Triple<L>{L::load(at[0] + k), L::load(at[1] + k), L::load(at[2] + k)});
  }
  return true;
}

/// Coordinates of at most 2^31 in size: where they are whole numbers, the nearest ones; fast, and
/// the same everywhere.
template <class To>
SINEW_INLINE void store_rounded(const double* values, int count, To* to) {
  for (int k = 0; k < count; ++k) {
    if constexpr (sizeof(To) == 4) {
      constexpr double shift = 6755399441055744.0;  // 1.5 2^52: the last bit is 1
      const auto bits = __builtin_bit_cast(std::uint64_t, values[k] + shift);
      to[k] = static_cast<To>(static_cast<std::uint32_t>(bits));
    } else {
      to[k] = values[k];
    }
  }
}

/// `L`: of doubles. Fewer particles than a vector has lanes are padded.
template <class L, class Real, int terms>
void put_group(const PutInput<Real>& input) {
  const auto put = [&](std::size_t k, const Triple<L>& at, int count)
      __attribute__((always_inline)) {
    double values[L::width];
    for (int axis = 0; axis < 3; ++axis) {
      L::store(values, polynomial<L, terms>(input.x + axis * cubic_terms, at));
      store_rounded(values, count, input.state.x[axis] + k);
      L::store(values, polynomial<L, terms>(input.v + axis * cubic_terms, at));
      for (int n = 0; n < count; ++n)
        input.state.v[axis][k + static_cast<std::size_t>(n)] = static_cast<Real>(values[n]);
    }
  };
  if (for_each_place<L>(
          input.at, input.begin,
          input.end, [&](std::size_t k, const Triple<L>& at) __attribute__((always_inline)) {
            put(k, at, L::width);
          }))
    return;
  double places[3][L::width] = {};
  const auto count = static_cast<int>(input.end - input.begin);
  for (int axis = 0; axis < 3; ++axis)
    for (int n = 0; n < count; ++n)
      places[axis][n] = input.at[axis][input.begin + static_cast<std::size_t>(n)];
  put(input.begin, {L::load(places[0]), L::load(places[1]), L::load(places[2])}, count);
}

/// At particles of a group; those between them in memory may count as well.
template <class L, int terms>
double largest_of_field(const FieldInput& input) {
  using V = typename L::V;
  V largest = L::all(0);
  const auto visit = [&](std::size_t, const Triple<L>& at) __attribute__((always_inline)) {
    const V a = polynomial<L, terms>(input.value, at),
            b = polynomial<L, terms>(input.value + cubic_terms, at),
            c = polynomial<L, terms>(input.value + 2 * cubic_terms, at);
    largest = L::larger(largest, L::fused(a, a, L::fused(b, b, c * c)));
  };
  const std::size_t end = input.end - input.begin < L::width && input.begin + L::width <= input.size
                              ? input.begin + L::width
                              : input.end;
  for_each_place<L>(input.at, end - input.begin < L::width ? end - L::width : input.begin, end,
                    visit);
  double lanes[L::width], most = 0;
  L::store(lanes, largest);
  for (const double one : lanes) most = one > most ? one : most;
  return most;
}

}  // namespace sinew::kernel
