// SPDX-License-Identifier: GPL-3.0-or-later
// What every stepper offers to Simulation, which calls it once for a batch of steps. A stepper has
// the state of the particles, in whatever order and units it likes, and takes all that acts on them
// as data: the body, its world, and the poses of its bones at the moments of the steps. The list
// stepper (list_stepper.h) is the fast one, the cells (cell_stepper.h) the readable one.
//
//     stepper.advance(moments, sums);        // so many steps, nothing is read between them
//     for (const StepSums& one : sums) ledger.add_step(one.power, one.lost);
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <sinew/body/forces.h>
#include <sinew/body/grouping.h>
#include <sinew/core/simulation_state.h>
#include <sinew/lists/list_counts.h>
#include <sinew/rig/pose.h>

namespace sinew {

class BondRest;
struct Stepping;

/// A particle whose motion in a step is invalid, by its place in the caller's order.
struct Offender {
  std::size_t particle = 0;
  bool finite = true;
  double moved = 0;  ///< relative to its bone, m; 0 where that is not finite
};

/// A step that was rejected.
struct Failure {
  Offender first;  ///< the one with the lowest place
  std::vector<Offender> all;
};

/// How far from equilibrium a body is at the positions that a step began with: sums over what is
/// free to move.
struct Imbalance {
  double aa = 0, av = 0, vv = 0;  ///< sums of accelerations a and velocities v, m^2/s^4 to m^2/s^2
  double flowing = 0;             ///< energy lost to bonds that flow or break, W
  double unbalanced = 0;  ///< the lengths of all forces on particles that nothing answers, N
  /// The largest of these, N: the lengths of all forces of loads, obstacles and (half) pins; the
  /// weight; half those of bones and fibers; a support's force, and its moment over the extent.
  double applied = 0;
  double loaded = 0;  ///< part of it by loads and the weight alone: exactly 0 without
};

/// Contributions of a step to the ledger, at the moment of the positions it began with.
struct StepSums {
  double power = 0;  ///< power of the bones, W
  double lost = 0;   ///< to damping, drag and friction, W
  std::optional<Failure> failure;
  double world_power = 0;   ///< power of moving obstacles, fields, muscles and pins, W
  double held_kinetic = 0;  ///< energy of particles that pins hold, J
  Imbalance imbalance;      ///< only of steps that relax
};

/// The ledger at one moment.
struct Balance {
  double power = 0, lost = 0;               ///< W
  double pair_energy = 0, bone_energy = 0;  ///< J
  double world_power = 0;                   ///< W
  double contact_energy = 0;                ///< in the springs of obstacles, J
  double held_kinetic = 0;                  ///< energy of particles that pins hold, J
};

/// A time (s) and the pose of the bones then.
struct TimedPose {
  double time = 0;
  Pose pose;
};

/// What acts between the body and its world, one for each obstacle, bone, support and load of it;
/// empty without a world.
struct WorldReactions {
  std::vector<Reaction> obstacles;  ///< reactions of the body on each, about its frame
  std::vector<Reaction> pins;       ///< reactions of the body on each bone by pins, about its head
  std::vector<Reaction> supports, loads;  ///< reactions of each on the body, about its pivot

  /// Adds those of damping relative to bones, which count as of pins, and supports.
  void add(const WorldReactions& of_damping);
};

inline void WorldReactions::add(const WorldReactions& of_damping) {
  for (const auto part : {&WorldReactions::pins, &WorldReactions::supports}) {
    const std::vector<Reaction>& more = of_damping.*part;
    (this->*part).resize(std::max((this->*part).size(), more.size()));
    for (std::size_t k = 0; k < more.size(); ++k) (this->*part)[k] += more[k];
  }
}

class Stepper {
 public:
  Stepper() = default;
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;
  virtual ~Stepper() = default;

  /// Makes steps that begin at these moments, one after another, and adds the contributions of each
  /// to `sums`. Ends with a step that fails, in which no particle moves; bonds that broke in it
  /// stay broken.
  virtual void advance(std::span<const TimedPose> begins, std::vector<StepSums>& sums) = 0;
  /// Sets the size of the steps that follow, s; velocities stay as they are.
  virtual void set_step(double step) = 0;
  /// Lets particles move so far in a step, in radii, before it fails; initially max_radii_per_step.
  virtual void allow_moves(double) {}

  // What is asked for at a moment that no step has left behind.

  /// Fills the forces in the caller's order.
  virtual Balance evaluate(const TimedPose& now, Forces& forces) = 0;
  /// Positions and velocities, in the caller's order. What pins hold is where they hold it then.
  virtual void read(const TimedPose& now, Particles& particles) = 0;
  /// Returns those evaluated last.
  virtual WorldReactions reactions() const { return {}; }
  /// Counts by particle in the caller's order; none where the material has no bonds.
  virtual std::vector<std::int32_t> broken_bonds() const { return {}; }
  virtual void read(BondRest&) const {}
  virtual ListCounts counts() const { return {}; }

  /// All that steps change, to the last bit; restore() throws bad input for what does not fit.
  virtual void save(SimulationState& state) = 0;
  virtual void restore(const SimulationState& state) = 0;

  // Steps that bring a body to rest, of steppers that have them.

  virtual bool relaxes() const { return false; }
  /// Velocities keep that fraction of themselves, and gain accordingly less. Moves nothing yet:
  /// accept() does.
  virtual StepSums try_step(const TimedPose&, double) { return {}; }
  virtual void accept() {}
  virtual void halt() {}            ///< all velocities become 0
  enum class Move { slight, far };  ///< slight: much less than a radius, and back again
  /// Puts the particles at these places, in the caller's order.
  virtual void place(const Points&, Move) {}

  // Groups of particles that move as one, of steppers that have them.

  virtual bool has_groups() const { return false; }
  /// After the body's grouping has changed: groups move as nearly as they can like their particles.
  virtual void regroup() {}
  /// The same without a change of the grouping: velocities have changed.
  virtual void fit_groups() {}
  /// Accelerations that groups do not follow, summed by cell of the body (`cell`: of each particle,
  /// by id), after a step.
  virtual std::vector<ConstrainedCell> constrained_cells(std::span<const std::int32_t>,
                                                         std::size_t) const {
    return {};
  }
};

}  // namespace sinew
