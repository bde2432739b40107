// SPDX-License-Identifier: GPL-3.0-or-later
// How far particles of a piece may move before its bonds have to be looked at again.
#pragma once

#include <algorithm>
#include <cmath>

#include <sinew/kernel/kernel.h>

namespace sinew {

/// Least distance by which particles may move relative to each other before any of them yields.
///
/// With e = (d - l) d / l0^2 of each bond, the tensor T of body/solid.h is a mean of (e - mean e) n
/// n^T. If the two particles of every bond move relative to each other by g at most, e changes by
/// no more than ((d + |d - l|) g + g^2) / l0^2, and n n^T, of norm 1, by no more than 2.3 g / d,
/// for g below d / 2. The shear is the norm of D = 15/2 dev T.
template <class Real>
double still_length(const kernel::FlowLook<Real>& look, double diameter, double longest) {
  const auto spare = static_cast<double>(look.spare), reach = static_cast<double>(look.reach);
  if (!(spare > 0) || !(reach < longest)) return 0;
  const double nearest = std::min(std::sqrt(static_cast<double>(look.nearest2)), diameter);
  const double most = std::min(nearest / 2, diameter / 10), l2 = diameter * diameter;
  const double tension = static_cast<double>(look.tension) / l2;
  const double slope = 7.5 * (2 * (reach + most) / l2 + 2 * tension * 2.3 / nearest);
  return std::min(most, 0.99 * spare / slope);
}

}  // namespace sinew
