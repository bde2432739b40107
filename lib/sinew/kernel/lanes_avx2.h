// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of 32 bytes. lanes.h explains the names.
#pragma once

#include <immintrin.h>
#include <cstdint>

namespace sinew::kernel::avx2 {

struct Doubles {
  using Real = double;
  using Coord = double;
  using V = __m256d;
  using C = __m256d;
  using M = __m256d;  // all bits of a lane set or none
  static constexpr int width = 4;

  static V all(double value) { return _mm256_set1_pd(value); }
  static V load(const double* p) { return _mm256_loadu_pd(p); }
  static void store(double* p, V v) { _mm256_storeu_pd(p, v); }
  static V root(V v) { return _mm256_sqrt_pd(v); }
  static V fused(V a, V b, V c) { return _mm256_fmadd_pd(a, b, c); }
  static V less_fused(V a, V b, V c) { return _mm256_fnmadd_pd(a, b, c); }
  static V larger(V a, V b) { return _mm256_max_pd(a, b); }
  static V smaller(V a, V b) { return _mm256_min_pd(a, b); }
  static V size(V v) { return _mm256_andnot_pd(all(-0.0), v); }
  static M less(V a, V b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
  static M at_most(V a, V b) { return _mm256_cmp_pd(a, b, _CMP_LE_OQ); }
  static M mask(std::uint32_t bits) {
    const __m256i own = _mm256_setr_epi64x(1, 2, 4, 8);
    const __m256i set = _mm256_and_si256(_mm256_set1_epi64x(bits), own);
    return _mm256_castsi256_pd(_mm256_cmpeq_epi64(set, own));
  }
  static std::uint32_t bits(M m) { return static_cast<std::uint32_t>(_mm256_movemask_pd(m)); }
  static bool any(M m) { return _mm256_movemask_pd(m) != 0; }
  static bool every(M m) { return _mm256_movemask_pd(m) == 0xf; }
  static V keep(M m, V v) { return _mm256_and_pd(m, v); }
  static V pick(M m, V yes, V no) { return _mm256_blendv_pd(no, yes, m); }
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
  using V = __m256;
  using C = __m256i;
  using M = __m256;
  static constexpr int width = 8;

  static V all(float value) { return _mm256_set1_ps(value); }
  static V load(const float* p) { return _mm256_loadu_ps(p); }
  static void store(float* p, V v) { _mm256_storeu_ps(p, v); }
  static V root(V v) { return _mm256_sqrt_ps(v); }
  static V fused(V a, V b, V c) { return _mm256_fmadd_ps(a, b, c); }
  static V less_fused(V a, V b, V c) { return _mm256_fnmadd_ps(a, b, c); }
  static V larger(V a, V b) { return _mm256_max_ps(a, b); }
  static V smaller(V a, V b) { return _mm256_min_ps(a, b); }
  static V size(V v) { return _mm256_andnot_ps(all(-0.0F), v); }
  static M less(V a, V b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
  static M at_most(V a, V b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
  static M mask(std::uint32_t bits) {
    const __m256i own = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i set = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), own);
    return _mm256_castsi256_ps(_mm256_cmpeq_epi32(set, own));
  }
  static std::uint32_t bits(M m) { return static_cast<std::uint32_t>(_mm256_movemask_ps(m)); }
  static bool any(M m) { return _mm256_movemask_ps(m) != 0; }
  static bool every(M m) { return _mm256_movemask_ps(m) == 0xff; }
  static V keep(M m, V v) { return _mm256_and_ps(m, v); }
  static V pick(M m, V yes, V no) { return _mm256_blendv_ps(no, yes, m); }
  static V add_where(M m, V sum, V v) { return sum + keep(m, v); }

  static C load_coord(const std::int32_t* p) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
  }
  static void store_coord(std::int32_t* p, C c) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), c);
  }
  static C all_coord(std::int32_t value) { return _mm256_set1_epi32(value); }
  static V difference(C a, C b) { return _mm256_cvtepi32_ps(_mm256_sub_epi32(a, b)); }
  static C moved(C c, V by) { return _mm256_add_epi32(c, _mm256_cvtps_epi32(by)); }
};

}  // namespace sinew::kernel::avx2
