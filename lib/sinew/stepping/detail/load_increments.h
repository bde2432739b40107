// SPDX-License-Identifier: GPL-3.0-or-later
// Brings a body to rest at one moment after another, by Newton's method where that may be and
// leads there, else by relaxation. A load that would strain the body too much at once, or lead to
// no equilibrium, or to an unstable one, is applied in increments.
//
//     LoadIncrements increments(body, load_steps, stepper, stepping, particles, moment_at);
//     while (!increments.relaxation().done()) increments.iterate(stepper, steps, offenders);
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <sinew/core/simulation_state.h>
#include <sinew/stepping/detail/increment_strain.h>
#include <sinew/stepping/detail/newton.h>
#include <sinew/stepping/equilibrium.h>

namespace sinew {

class LoadIncrements {
 public:
  /// The pose at a time (s), in which the bones stand still.
  using MomentAt = std::function<TimedPose(double time)>;

  /// `particles` have the ids in the caller's order.
  LoadIncrements(const Body& body, LoadSteps steps, Stepper& stepper, const Stepping& stepping,
                 const Particles& particles, MomentAt moment_at);

  const Relaxation& relaxation() const { return relaxation_; }
  /// One iteration. Where it failed, the particles in `offenders`. Throws what Relaxation throws.
  Relaxation::Outcome iterate(Stepper& stepper, std::int64_t steps,
                              std::vector<Offender>& offenders);

  void save(SimulationState& state) const;
  /// The stepper's own state restored or not, it is that of `state` then.
  void restore(Stepper& stepper, const SimulationState& state);

 private:
  TimedPose moment() const { return moment_at_(relaxation_.time()); }
  Points positions(Stepper& stepper);
  void begin(Stepper& stepper);
  void go_back(Stepper& stepper, const RelaxationState& to);
  void try_otherwise(Stepper& stepper);
  bool is_given_up(Stepper& stepper, double times);
  void accept(Stepper& stepper);
  Relaxation::Outcome relax(Stepper& stepper, std::vector<Offender>& offenders);
  Relaxation::Outcome solve(Stepper& stepper);
  bool predict(Stepper& stepper);
  void settle(Stepper& stepper);

  Relaxation relaxation_;
  SharedNeighbors near_;
  StrainMeter strain_;
  std::unique_ptr<Newton> newton_;  ///< none: it does not apply
  MomentAt moment_at_;
  Particles particles_;
  std::shared_ptr<const SimulationState> begun_;  ///< where the present increment began
  std::int64_t steps_ = 0;
};

}  // namespace sinew
