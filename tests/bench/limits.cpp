// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/limits.h"

#if defined(__x86_64__)
#define SINEW_AVX512 __attribute__((target("avx512f,fma"), noinline))
#define SINEW_AVX2 __attribute__((target("avx2,fma"), noinline))
#else
#define SINEW_AVX512
#define SINEW_AVX2
#endif
#define SINEW_INLINE __attribute__((always_inline)) inline

namespace sinew::bench {
namespace {

// Enough independent sums to fill two units of four cycles' latency, few enough for 16 registers.
constexpr int sums = 12;

template <class Number, int bytes>
struct Vector {
  using Type [[gnu::vector_size(bytes)]] = Number;
};

/// A value that the compiler must not optimize away.
template <class Number>
SINEW_INLINE Number opaque(Number value) {
  volatile Number hidden = value;
  return hidden;
}

template <class Number, int bytes>
SINEW_INLINE double multiply_adds(std::int64_t rounds) {
  using Lanes = typename Vector<Number, bytes>::Type;
  constexpr int lanes = bytes / sizeof(Number);
  const Lanes factor = Lanes{} + opaque(Number(0.999)), term = Lanes{} + opaque(Number(0.001));
  Lanes sum[sums];
  for (int k = 0; k < sums; ++k) sum[k] = Lanes{} + opaque(Number(k));
  for (std::int64_t round = 0; round < rounds; ++round)
#pragma GCC unroll 12
    for (int k = 0; k < sums; ++k) sum[k] = sum[k] * factor + term;
  for (int k = 0; k < sums; ++k) opaque(sum[k][0]);
  return 2.0 * sums * lanes * static_cast<double>(rounds);
}

template <int bytes>
SINEW_INLINE void triads(double* a, const double* b, const double* c, std::size_t begin,
                         std::size_t end) {
  using Lanes [[gnu::vector_size(bytes), gnu::aligned(8), gnu::may_alias]] = double;
  constexpr std::size_t lanes = bytes / sizeof(double);
  std::size_t i = begin;
  for (; i + lanes <= end; i += lanes)
    *reinterpret_cast<Lanes*>(a + i) =
        *reinterpret_cast<const Lanes*>(b + i) + 3.0 * *reinterpret_cast<const Lanes*>(c + i);
  for (; i < end; ++i) a[i] = b[i] + 3.0 * c[i];
}

template <class Number>
SINEW_AVX512 double wide(std::int64_t rounds) {
  return multiply_adds<Number, 64>(rounds);
}
template <class Number>
SINEW_AVX2 double half(std::int64_t rounds) {
  return multiply_adds<Number, 32>(rounds);
}
SINEW_AVX512 void wide_triads(double* a, const double* b, const double* c, std::size_t begin,
                              std::size_t end) {
  triads<64>(a, b, c, begin, end);
}
SINEW_AVX2 void half_triads(double* a, const double* b, const double* c, std::size_t begin,
                            std::size_t end) {
  triads<32>(a, b, c, begin, end);
}

template <class Number>
double by_set(InstructionSet set, std::int64_t rounds) {
  if (set == InstructionSet::avx512) return wide<Number>(rounds);
  if (set == InstructionSet::avx2) return half<Number>(rounds);
  return multiply_adds<Number, 16>(rounds);
}

}  // namespace

InstructionSet widest() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) return InstructionSet::avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return InstructionSet::avx2;
#endif
  return InstructionSet::baseline;
}

const char* name_of(InstructionSet set) {
  if (set == InstructionSet::avx512) return "AVX-512";
  return set == InstructionSet::avx2 ? "AVX2" : "baseline";
}

double multiply_add_single(InstructionSet set, std::int64_t rounds) {
  return by_set<float>(set, rounds);
}

double multiply_add_double(InstructionSet set, std::int64_t rounds) {
  return by_set<double>(set, rounds);
}

void triad(InstructionSet set, double* a, const double* b, const double* c, std::size_t begin,
           std::size_t end) {
  if (set == InstructionSet::avx512) return wide_triads(a, b, c, begin, end);
  if (set == InstructionSet::avx2) return half_triads(a, b, c, begin, end);
  triads<16>(a, b, c, begin, end);
}

}  // namespace sinew::bench
