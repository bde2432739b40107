// SPDX-License-Identifier: GPL-3.0-or-later
// One lane, for other processors and as a reference for the vectors. lanes.h explains the names.
#pragma once

#include <cmath>
#include <cstdint>

namespace sinew::kernel::plain {

template <class R>
struct One {
  using Real = R;
  using V = R;
  using M = bool;
  static constexpr int width = 1;

  static V all(R value) { return value; }
  static V load(const R* p) { return *p; }
  static void store(R* p, V v) { *p = v; }
  static V root(V v) { return std::sqrt(v); }
  static V fused(V a, V b, V c) { return std::fma(a, b, c); }
  static V less_fused(V a, V b, V c) { return std::fma(-a, b, c); }
  static V larger(V a, V b) { return a > b ? a : b; }
  static V smaller(V a, V b) { return a < b ? a : b; }
  static V size(V v) { return std::fabs(v); }
  static M less(V a, V b) { return a < b; }
  static M at_most(V a, V b) { return a <= b; }
  static M mask(std::uint32_t bits) { return (bits & 1) != 0; }
  static std::uint32_t bits(M m) { return m ? 1 : 0; }
  static bool any(M m) { return m; }
  static bool every(M m) { return m; }
  static V keep(M m, V v) { return m ? v : 0; }
  static V pick(M m, V yes, V no) { return m ? yes : no; }
  static V add_where(M m, V sum, V v) { return m ? sum + v : sum; }
};

struct Doubles : One<double> {
  using Coord = double;
  using C = double;
  static C load_coord(const double* p) { return *p; }
  static void store_coord(double* p, C c) { *p = c; }
  static C all_coord(double value) { return value; }
  static V difference(C a, C b) { return a - b; }
  static C moved(C c, V by) { return c + by; }
};

struct Floats : One<float> {
  using Coord = std::int32_t;
  using C = std::uint32_t;  // wraps around, like the vectors
  static C load_coord(const std::int32_t* p) { return static_cast<C>(*p); }
  static void store_coord(std::int32_t* p, C c) { *p = static_cast<Coord>(c); }
  static C all_coord(std::int32_t value) { return static_cast<C>(value); }
  static V difference(C a, C b) { return static_cast<float>(static_cast<Coord>(a - b)); }
  static C moved(C c, V by) {
    // What 32 bits cannot hold becomes the least integer, as in the vectors.
    const bool fits = std::fabs(by) < 2147483648.0F;
    return c + (fits ? static_cast<C>(static_cast<Coord>(std::nearbyint(by))) : C{1} << 31);
  }
};

}  // namespace sinew::kernel::plain
