// SPDX-License-Identifier: GPL-3.0-or-later
// Where bonds of a list stepper may flow. That is found before a step; but only of pieces that may
// have come to it since they were looked at, which most of a body has not.
#include <sinew/physics/lists/list_stepper.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/parallel.h>

namespace sinew {
namespace {

/// How far particles may move relative to each other, at least, before any of them yields.
///
/// With e = (d - l) d / l0^2 of each bond, the tensor T of ../solid.h is a mean of (e - mean e) n
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

}  // namespace

template <class Real>
void ListStepper<Real>::find_flow(const kernel::Step<Real>& now) {
  if (bonds_.look.empty()) return;
  const auto flows = [&](std::size_t piece) { return bonds_.look[piece].spare <= 0; };
  const std::vector<std::uint32_t> pieces = lists_.to_look_at(flows);
  parallel_for(pieces.size(), pieces_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) kernel_.flow(now, pieces[k], pieces[k] + 1);
  });
  const bool relaxes = now.bonds.branches > 0;  // whose stress changes while nothing moves
  const double diameter = 2 * body_->material.pair.r / layout_.units().length;
  for (const std::uint32_t piece : pieces)
    lists_.looked_at(
        piece, relaxes ? 0 : still_length(bonds_.look[piece], diameter, lists_.outer_range()));
}

template void ListStepper<double>::find_flow(const kernel::Step<double>&);
template void ListStepper<float>::find_flow(const kernel::Step<float>&);

}  // namespace sinew
