// SPDX-License-Identifier: GPL-3.0-or-later
// The angle from (1, 0) to (x, y), of every lane.
#pragma once

#include "physics/kernel/parts.h"

namespace sinew::kernel {

// atan t = t + t^3 q(t^2) for |t| <= tan(pi / 8): q by a Chebyshev fit, with an error of atan t / t
// below 6e-18 (double) and 3e-9 (float).
template <class L>
SINEW_INLINE typename L::V short_arctangent(typename L::V t) {
  using V = typename L::V;
  using Real = typename L::Real;
  const auto all = [](double c) { return L::all(static_cast<Real>(c)); };
  const V s = t * t, s2 = s * s;
  // In pairs of terms, which do not wait for each other.
  const auto two = [&](double c0, double c1) { return L::fused(all(c1), s, all(c0)); };
  if constexpr (sizeof(Real) == 4) {
    const V low = two(-0.33333331761161, 0.19999540481962);
    const V high = L::fused(all(-0.06451926114690), s2, two(-0.14263955539545, 0.10743730859150));
    return L::fused(t * s, L::fused(s2, high, low), t);
  } else {
    const V s4 = s2 * s2;
    const V low = L::fused(s2, two(-0.14285714284666534304, 0.11111111015255668508),
                           two(-0.3333333333333333016, 0.19999999999995520637));
    const V middle = L::fused(s2, two(-0.066645114381646448357, 0.058581488327312729465),
                              two(-0.090909045780957349208, 0.076921831901717284121));
    const V high = L::fused(s2, all(-0.019176872294336066637),
                            two(-0.050854493189300349167, 0.039231646190551487845));
    return L::fused(t * s, L::fused(s4, L::fused(s4, high, middle), low), t);
  }
}

/// In (-pi, pi]; not a number for (0, 0).
template <class L>
SINEW_INLINE typename L::V arctangent(typename L::V y, typename L::V x) {
  using V = typename L::V;
  using Real = typename L::Real;
  constexpr Real pi = static_cast<Real>(3.14159265358979323846);
  const V steep = L::all(static_cast<Real>(0.41421356237309504880));  // tan(pi / 8)
  const V rise = L::size(y), run = L::size(x);
  if (L::every(L::at_most(rise, steep * x))) return short_arctangent<L>(y / x);
  const auto low = L::at_most(rise, steep * run), high = L::at_most(run, steep * rise);
  const V over = L::pick(low, rise, L::pick(high, L::all(0) - run, rise - run));
  const V under = L::pick(low, run, L::pick(high, rise, rise + run));
  const V turned = L::pick(low, L::all(0), L::pick(high, L::all(pi / 2), L::all(pi / 4)));
  const V angle = turned + short_arctangent<L>(over / under);
  const V all_round = L::pick(L::less(x, L::all(0)), L::all(pi) - angle, angle);
  return L::pick(L::less(y, L::all(0)), L::all(0) - all_round, all_round);
}

}  // namespace sinew::kernel
