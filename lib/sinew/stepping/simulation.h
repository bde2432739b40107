// SPDX-License-Identifier: GPL-3.0-or-later
// A body on its moving bones, advanced step by step:
//
//     Simulation simulation(body, motion, particles, stepping);
//     while (simulation.time() < end) simulation.step();
//
// Results are in the order of the particles it was given.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/body/forces.h>
#include <sinew/body/ledger.h>
#include <sinew/body/step_plan.h>
#include <sinew/core/options.h>
#include <sinew/core/particles.h>
#include <sinew/core/simulation_state.h>
#include <sinew/groups/dynamic/dynamic_groups.h>
#include <sinew/lists/list_counts.h>
#include <sinew/rig/motion.h>
#include <sinew/rig/pose.h>
#include <sinew/stepping/cell_stepper.h>
#include <sinew/stepping/list_stepper.h>
#include <sinew/stepping/relaxation.h>
#include <sinew/stepping/stepper.h>

namespace sinew {

class Simulation {
 public:
  /// `particles` in any order; their id is their place in body.rest. The kernel is compiled for
  /// several instruction sets; all of them give the same bits. Throws bad input for a position that
  /// is not finite.
  Simulation(Body body, Motion motion, Particles particles, const Stepping& stepping,
             kernel::InstructionSet instructions = kernel::best_instruction_set());

  /// From the start on, steps are of the sizes in the plan. Call it before the first step.
  void follow(StepPlan plan);

  /// From the start on, steps are iterations that bring an undamped() body to rest at one moment
  /// after another; time() is that of its bones and surroundings. Call it before the first step.
  /// Throws bad input for the reference stepper.
  void relax(LoadSteps steps);
  /// What it has come to; none where it was not asked to.
  const Relaxation* relaxation() const { return relaxation_ ? &*relaxation_ : nullptr; }

  /// From now on, groups of particles change as the body moves. Throws bad input for the reference
  /// stepper.
  void group_as_it_moves(const DynamicOptions& options);
  /// Lost where particles joined groups, J; part of the dissipation.
  double lost_by_merging() const { return regrouping_.lost; }
  std::int64_t regroupings() const { return regrouping_.times; }

  /// From now on the bones move so; at the present moment the pose should be the same. Throws bad
  /// input where there are groups of particles, static or dynamic: they are made for one motion.
  void play(Motion motion);

  /// Advances by one step. Throws Error (unstable) that names step, particle, cause and a cure when
  /// a value is not finite or a particle moves over 0.25 r relative to its bone in the step (one
  /// without a bone: relative to its previous motion). The particles stay where they were before
  /// the step; bonds that broke in it stay broken.
  void step();
  /// Of the step that failed, in the order of the particles.
  const std::vector<Offender>& offenders() const { return offenders_; }

  double time() const;  ///< s
  std::int64_t steps() const { return steps_; }
  const Body& body() const { return *body_; }
  const Particles& particles() const;
  const Pose& pose() const { return cursor_.at(time()); }  ///< until the next step

  /// At the present moment.
  const Forces& forces();
  /// particles() and forces() without a copy, for a caller who keeps them; both are found anew when
  /// they are asked for again.
  Particles take_particles();
  Forces take_forces();
  /// Memory of earlier ones, for those that are found next: spares the system from clearing new.
  void reuse(Particles particles, Forces forces);

  /// Kinetic energy and dissipation are evaluated at the moment of the positions, so that the
  /// balance closes to second order in the step.
  Energies energies();

  /// Broken bonds of each particle, in the order of the particles; none for the paper's model,
  /// which has no bonds.
  std::vector<std::int32_t> broken_bonds() const;

  /// The rest length of each bond now, m, 0 once broken: by entry of `nearest`, then of `second`,
  /// the neighbors at rest by id, ascending. Zeros for a material without bonds.
  std::vector<double> rest_of_bonds(const NeighborLists& nearest,
                                    const NeighborLists& second) const;

  /// The force of the body on each obstacle of its world at the present moment, about its frame.
  std::vector<Reaction> reactions_of_obstacles();
  /// The force of each support and load of its world on the body at the present moment, about its
  /// pivot. The inertia of what supports hold is not part of it.
  std::vector<Reaction> of_supports();
  std::vector<Reaction> of_loads();
  /// The force of the body on each bone at the present moment, about its head.
  BoneReactions reactions_of_bones();

  /// The state from which a simulation continues with the same bits, on any number of threads.
  SimulationState save() const;
  /// Continues from that moment of a simulation of the same body, motion and stepping. Throws bad
  /// input for a state that does not fit.
  void restore(const SimulationState& state);

  /// How often neighbor lists were built; zeros for the cell stepper.
  ListCounts list_counts() const;

 private:
  using Stepper = std::variant<CellStepper, ListStepper<double>, ListStepper<float>>;

  static Stepper make_stepper(const std::shared_ptr<const Body>& body, const Stepping& stepping,
                              Particles& particles, kernel::InstructionSet instructions);
  void evaluate();
  double mass(std::size_t i) const {
    return mass_of(*body_, static_cast<std::size_t>(particles_.id[i]), particles_.mass);
  }
  void relax_once();
  GroupingMoment grouping_moment() const;
  void check_groups();
  void regroup(std::span<const HeldCell> held, bool must);
  void set_grouping(std::vector<std::int32_t> group);
  void restore_grouping(const SimulationState& state);
  void move_in(std::vector<std::int32_t> group);
  void halt();
  const Pose& pose_of_stepper() const;
  void forget_read();
  void set_time() const;
  void set_step(double step);
  void change_step(double step);
  [[noreturn]] void fail();  ///< because of the worst of the offenders

  std::shared_ptr<Body> body_;  ///< whose grouping may change
  std::shared_ptr<const Motion> motion_;
  mutable PoseCursor cursor_;
  Stepping stepping_;  ///< with the step made last
  StepPlan plan_;
  std::optional<Relaxation> relaxation_;
  std::optional<DynamicGroups> dynamic_;
  RegroupingState regrouping_;
  mutable Pose still_;   ///< the pose without its velocities
  double unit_of_time_;  ///< of velocities in single precision, s
  std::int64_t steps_ = 0;
  mutable Stepper stepper_;
  EnergyLedger ledger_, world_ledger_;
  double held_at_start_ = 0;  ///< kinetic energy of what pins hold, J

  std::vector<Offender> offenders_;
  mutable Particles particles_;  ///< as read last; radius, mass and ids are always valid
  mutable bool read_ = false;    ///< whether they are those of the present moment
  Forces forces_;
  Balance balance_;
  bool evaluated_ = false;
};

}  // namespace sinew
