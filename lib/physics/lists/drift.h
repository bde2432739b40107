// SPDX-License-Identifier: GPL-3.0-or-later
// Until when a list holds: no pair outside it may have come within b.
//
// A list of the pairs within b + skin holds while particles have approached by no more than the
// skin. What each has moved relative to its carrier is bounded step by step by the fastest;
// the bound is replaced by a look at all of them when it has used up what there is.
#pragma once

#include "physics/lists/contacts.h"
#include "rig/pose.h"

namespace sinew {

class Drift {
 public:
  Drift() = default;
  explicit Drift(double skin) : skin_(skin) {}

  /// A step in which no particle moved more than `length` (m) relative to its carrier.
  void add(double length) { moved_ += length; }
  /// A look at all particles found that none is farther than this from where it was (m).
  void found(double length) { moved_ = length; }

  double moved() const { return moved_; }
  /// Whether the list still holds when the carriers alone have brought particles nearer by this
  /// (m). A little of the skin is left to rounding, of floats at most.
  bool holds(double approach) const { return 2 * moved_ + approach < skin_ * (1 - 1e-5); }
  double skin() const { return skin_; }

 private:
  double skin_ = 0, moved_ = 0;
};

/// How much farther than its velocity says a frame has carried particles within `reach` (m) of its
/// head in a step from `before` to `now`: m.
double excess_of_step(const BonePose& before, const BonePose& now, double step, double reach);

}  // namespace sinew
