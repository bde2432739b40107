// SPDX-License-Identifier: GPL-3.0-or-later
// Damping relative to what holds a body, for the list stepper: RigidReferences in the layout of the
// kernel, and what bones and supports answer for.
//
//     brakes.find(steps, moment, stepper, state, units);  // before a step
//     step.rigid = brakes.arrays(units);
#pragma once

#include <memory>
#include <vector>

#include <sinew/lists/rigid_slots.h>
#include <sinew/stepping/detail/rigid_references.h>

namespace sinew {

template <class Real>
class RigidBrakes {
 public:
  explicit RigidBrakes(const std::shared_ptr<const Body>& body) : body_(body), references_(body) {}

  /// The particles `id` in the kernel's order.
  void set_order(std::span<const std::int32_t> id);
  /// Before a step after so many.
  void find(std::int64_t steps, const TimedPose& moment, const Stepper& stepper,
            BlockState<Real>& state, const Units& units);
  kernel::RigidDamping<Real> arrays(const Units& units) const;
  /// Sums up what bones, as pins on them, and supports answer for; `mass` of a particle of the
  /// material's density, kg.
  WorldReactions reactions(const BlockState<Real>& state, const Units& units, double mass) const;

  void save(SimulationState& state) const { references_.save(state); }
  /// Before set_order().
  void restore(const SimulationState& state) { references_.restore(state); }

 private:
  void find_slots();

  std::shared_ptr<const Body> body_;
  RigidReferences references_;
  std::vector<std::int32_t> id_;
  RigidSlots<Real> slots_;
  std::vector<kernel::AffineMotion<Real>> motions_;  ///< at the moment
};

}  // namespace sinew
