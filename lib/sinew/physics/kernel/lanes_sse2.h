// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of 16 bytes, which every x86-64 has. lanes.h explains the names.
#pragma once

#include <emmintrin.h>
#include <cmath>
#include <cstdint>

namespace sinew::kernel::sse2 {

struct Doubles {
  using Real = double;
  using Coord = double;
  using V = __m128d;
  using C = __m128d;
  using M = __m128d;  // all bits of a lane set or none
  static constexpr int width = 2;

  static V all(double value) { return _mm_set1_pd(value); }
  static V load(const double* p) { return _mm_loadu_pd(p); }
  static void store(double* p, V v) { _mm_storeu_pd(p, v); }
  static V root(V v) { return _mm_sqrt_pd(v); }
  static V fused(V a, V b, V c) {
    double x[width], y[width], z[width];
    store(x, a), store(y, b), store(z, c);
    for (int k = 0; k < width; ++k) z[k] = std::fma(x[k], y[k], z[k]);
    return load(z);
  }
  static V less_fused(V a, V b, V c) { return fused(_mm_xor_pd(a, all(-0.0)), b, c); }
  static V larger(V a, V b) { return _mm_max_pd(a, b); }
  static V smaller(V a, V b) { return _mm_min_pd(a, b); }
  static V size(V v) { return _mm_andnot_pd(all(-0.0), v); }
  static M less(V a, V b) { return _mm_cmplt_pd(a, b); }
  static M at_most(V a, V b) { return _mm_cmple_pd(a, b); }
  static M mask(std::uint32_t bits) {
    const __m128i own = _mm_setr_epi32(1, 1, 2, 2);
    const __m128i set = _mm_and_si128(_mm_set1_epi32(static_cast<int>(bits)), own);
    return _mm_castsi128_pd(_mm_cmpeq_epi32(set, own));
  }
  static std::uint32_t bits(M m) { return static_cast<std::uint32_t>(_mm_movemask_pd(m)); }
  static bool any(M m) { return _mm_movemask_pd(m) != 0; }
  static bool every(M m) { return _mm_movemask_pd(m) == 0x3; }
  static V keep(M m, V v) { return _mm_and_pd(m, v); }
  static V pick(M m, V yes, V no) { return _mm_or_pd(_mm_and_pd(m, yes), _mm_andnot_pd(m, no)); }
  static V add_where(M m, V sum, V v) { return sum + keep(m, v); }

  static C load_coord(const double* p) { return load(p); }
  static void store_coord(double* p, C c) { store(p, c); }
  static C all_coord(double value) { return all(value); }
  static V difference(C a, C b) { return a - b; }
  static C moved(C c, V by) { return c + by; }
};

struct Floats {
  using Real = float;
  using Coord = std::int32_t;
  using V = __m128;
  using C = __m128i;
  using M = __m128;
  static constexpr int width = 4;

  static V all(float value) { return _mm_set1_ps(value); }
  static V load(const float* p) { return _mm_loadu_ps(p); }
  static void store(float* p, V v) { _mm_storeu_ps(p, v); }
  static V root(V v) { return _mm_sqrt_ps(v); }
  static V fused(V a, V b, V c) {
    float x[width], y[width], z[width];
    store(x, a), store(y, b), store(z, c);
    for (int k = 0; k < width; ++k) z[k] = std::fma(x[k], y[k], z[k]);
    return load(z);
  }
  static V less_fused(V a, V b, V c) { return fused(_mm_xor_ps(a, all(-0.0F)), b, c); }
  static V larger(V a, V b) { return _mm_max_ps(a, b); }
  static V smaller(V a, V b) { return _mm_min_ps(a, b); }
  static V size(V v) { return _mm_andnot_ps(all(-0.0F), v); }
  static M less(V a, V b) { return _mm_cmplt_ps(a, b); }
  static M at_most(V a, V b) { return _mm_cmple_ps(a, b); }
  static M mask(std::uint32_t bits) {
    const __m128i own = _mm_setr_epi32(1, 2, 4, 8);
    const __m128i set = _mm_and_si128(_mm_set1_epi32(static_cast<int>(bits)), own);
    return _mm_castsi128_ps(_mm_cmpeq_epi32(set, own));
  }
  static std::uint32_t bits(M m) { return static_cast<std::uint32_t>(_mm_movemask_ps(m)); }
  static bool any(M m) { return _mm_movemask_ps(m) != 0; }
  static bool every(M m) { return _mm_movemask_ps(m) == 0xf; }
  static V keep(M m, V v) { return _mm_and_ps(m, v); }
  static V pick(M m, V yes, V no) { return _mm_or_ps(_mm_and_ps(m, yes), _mm_andnot_ps(m, no)); }
  static V add_where(M m, V sum, V v) { return sum + keep(m, v); }

  static C load_coord(const std::int32_t* p) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p));
  }
  static void store_coord(std::int32_t* p, C c) {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p), c);
  }
  static C all_coord(std::int32_t value) { return _mm_set1_epi32(value); }
  static V difference(C a, C b) { return _mm_cvtepi32_ps(_mm_sub_epi32(a, b)); }
  static C moved(C c, V by) { return _mm_add_epi32(c, _mm_cvtps_epi32(by)); }
};

}  // namespace sinew::kernel::sse2
