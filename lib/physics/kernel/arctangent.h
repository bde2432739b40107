// SPDX-License-Identifier: GPL-3.0-or-later
// The angle from (1, 0) to (x, y), of every lane.
#pragma once

#include "physics/kernel/parts.h"

namespace sinew::kernel {

// atan t = t + t^3 q(t^2) for |t| <= tan(pi / 8): q by a Chebyshev fit, with an error of atan t / t
// below 6e-18 (double) and 3e-9 (float).
template <class L>
SINEW_INLINE typename L::V short_arctangent(typename L::V t) {
  const typename L::V s = t * t;
  if constexpr (sizeof(typename L::Real) == 4) {
    constexpr float q[] = {-0.33333331761161F, 0.19999540481962F, -0.14263955539545F,
                           0.10743730859150F, -0.06451926114690F};
    typename L::V sum = L::all(q[4]);
    for (int k = 3; k >= 0; --k) sum = sum * s + L::all(q[k]);
    return t + t * s * sum;
  } else {
    constexpr double q[] = {
        -0.3333333333333333016,   0.19999999999995520637,   -0.14285714284666534304,
        0.11111111015255668508,   -0.090909045780957349208, 0.076921831901717284121,
        -0.066645114381646448357, 0.058581488327312729465,  -0.050854493189300349167,
        0.039231646190551487845,  -0.019176872294336066637};
    typename L::V sum = L::all(q[10]);
    for (int k = 9; k >= 0; --k) sum = sum * s + L::all(q[k]);
    return t + t * s * sum;
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
