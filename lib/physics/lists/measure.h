// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths, times and places as the kernel has them.
#pragma once

#include "core/vector.h"
#include "physics/pair_force.h"

namespace sinew {

/// How the kernel measures. Double precision keeps metres and seconds. Single precision counts time
/// in steps and positions as whole numbers of a small length from an origin.
struct Measure {
  double length = 1;  ///< m
  double time = 1;    ///< s
  Vec3 origin = Vec3::Zero();

  double acceleration(double si) const { return si * time * time / length; }
  double velocity(double si) const { return si * time / length; }
};

/// The measure for particles within `box` (m) that take steps of `step` (s).
template <class Real>
Measure measure_for(const Box& box, const PairForce& pair, double step);

/// Whether a measure still serves particles within `box` (m): whole numbers hold a body that has
/// grown or travelled far in a measure of its own.
template <class Real>
bool serves(const Measure& measure, const Box& box);

/// How far particles may travel before the measure is looked at again: m.
template <class Real>
double free_travel(const Measure& measure);

}  // namespace sinew
