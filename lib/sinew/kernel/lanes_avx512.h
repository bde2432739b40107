// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of 64 bytes. lanes.h explains the names.
#pragma once

#include <immintrin.h>
#include <cstdint>

namespace sinew::kernel::avx512 {

struct Doubles {
  using Real = double;
  using Coord = double;
  using V = __m512d;
  using C = __m512d;
  using M = __mmask8;
  static constexpr int width = 8;

  static V all(double value) { return _mm512_set1_pd(value); }
  static V load(const double* p) { return _mm512_loadu_pd(p); }
  static void store(double* p, V v) { _mm512_storeu_pd(p, v); }
  static V root(V v) { return _mm512_sqrt_pd(v); }
  static V fused(V a, V b, V c) { return _mm512_fmadd_pd(a, b, c); }
  static V less_fused(V a, V b, V c) { return _mm512_fnmadd_pd(a, b, c); }
  static V larger(V a, V b) { return _mm512_max_pd(a, b); }
  static V smaller(V a, V b) { return _mm512_min_pd(a, b); }
  static V size(V v) { return _mm512_abs_pd(v); }
  static M less(V a, V b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
  static M at_most(V a, V b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
  static M mask(std::uint32_t bits) { return static_cast<M>(bits); }
  static std::uint32_t bits(M m) { return m; }
  static bool any(M m) { return m != 0; }
  static bool every(M m) { return m == 0xff; }
  static V keep(M m, V v) { return _mm512_maskz_mov_pd(m, v); }
  static V pick(M m, V yes, V no) { return _mm512_mask_blend_pd(m, no, yes); }
  static V add_where(M m, V sum, V v) { return _mm512_mask_add_pd(sum, m, sum, v); }

  static C load_coord(const double* p) { return load(p); }
  static void store_coord(double* p, C c) { store(p, c); }
  static C all_coord(double value) { return all(value); }
  static V difference(C a, C b) { return a - b; }
  static C moved(C c, V by) { return c + by; }
};

struct Floats {
  using Real = float;
  using Coord = std::int32_t;
  using V = __m512;
  using C = __m512i;
  using M = __mmask16;
  static constexpr int width = 16;

  static V all(float value) { return _mm512_set1_ps(value); }
  static V load(const float* p) { return _mm512_loadu_ps(p); }
  static void store(float* p, V v) { _mm512_storeu_ps(p, v); }
  static V root(V v) { return _mm512_sqrt_ps(v); }
  static V fused(V a, V b, V c) { return _mm512_fmadd_ps(a, b, c); }
  static V less_fused(V a, V b, V c) { return _mm512_fnmadd_ps(a, b, c); }
  static V larger(V a, V b) { return _mm512_max_ps(a, b); }
  static V smaller(V a, V b) { return _mm512_min_ps(a, b); }
  static V size(V v) { return _mm512_abs_ps(v); }
  static M less(V a, V b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
  static M at_most(V a, V b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
  static M mask(std::uint32_t bits) { return static_cast<M>(bits); }
  static std::uint32_t bits(M m) { return m; }
  static bool any(M m) { return m != 0; }
  static bool every(M m) { return m == 0xffff; }
  static V keep(M m, V v) { return _mm512_maskz_mov_ps(m, v); }
  static V pick(M m, V yes, V no) { return _mm512_mask_blend_ps(m, no, yes); }
  static V add_where(M m, V sum, V v) { return _mm512_mask_add_ps(sum, m, sum, v); }

  static C load_coord(const std::int32_t* p) { return _mm512_loadu_si512(p); }
  static void store_coord(std::int32_t* p, C c) { _mm512_storeu_si512(p, c); }
  static C all_coord(std::int32_t value) { return _mm512_set1_epi32(value); }
  static V difference(C a, C b) { return _mm512_cvtepi32_ps(_mm512_sub_epi32(a, b)); }
  static C moved(C c, V by) { return _mm512_add_epi32(c, _mm512_cvtps_epi32(by)); }
};

}  // namespace sinew::kernel::avx512
