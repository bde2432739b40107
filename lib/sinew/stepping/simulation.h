// SPDX-License-Identifier: GPL-3.0-or-later
// A body on its moving bones, advanced step by step:
//
//     Simulation simulation(body, motion, particles, stepping);
//     while (simulation.time() < end) simulation.step();
//
// Results are in the order of the particles it was given.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <sinew/body/forces.h>
#include <sinew/core/energies.h>
#include <sinew/core/simulation_state.h>
#include <sinew/kernel/instruction_set.h>

namespace sinew {

/// What limits of the particles' speed, relative to their bones, have taken from a body.
struct LimitedSpeeds {
  std::vector<std::int32_t> in_frame = {};  ///< times of each, by place; empty: none
  std::int64_t times = 0;                   ///< since the start
  double energy = 0;                        ///< lost since then, J; part of the dissipation
  Vec3 impulse = Vec3::Zero();              ///< impulse of their bones on them since then, N s

  /// Whether it may be of a body of so many particles.
  bool is_of(std::size_t particles) const {
    return std::isfinite(energy) && impulse.allFinite() &&
           (in_frame.empty() || in_frame.size() == particles);
  }
};

template <class Archive>
void serialize(Archive& archive, LimitedSpeeds& state) {
  archive("in_frame", state.in_frame);
  archive("times", state.times);
  archive("energy", state.energy);
  archive("impulse", state.impulse);
}

class Relaxation;
class StepPlan;
class Stepper;
struct DynamicOptions;
struct ListCounts;
struct LoadSteps;
struct Motion;
struct NeighborLists;
struct NewGroups;
struct Offender;
struct StepSums;
struct Stepping;
struct TimedPose;

/// Makes the stepper of a body. It may take the motion out of the particles to spare memory.
using MakeStepper = std::function<std::unique_ptr<Stepper>(std::shared_ptr<const Body> body,
                                                           const Stepping&, Particles& particles)>;

class Simulation {
 public:
  /// `particles` in any order; their id is their place in body.rest. The kernel is compiled for
  /// several instruction sets; all of them give the same bits. Throws bad input for a position that
  /// is not finite.
  Simulation(Body body, Motion motion, Particles particles, const Stepping& stepping,
             kernel::InstructionSet instructions = kernel::best_instruction_set());
  /// The same with a stepper of one's own.
  Simulation(Body body, Motion motion, Particles particles, const Stepping& stepping,
             MakeStepper make);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  // What it is to do: before its first step, or from now on.

  /// Makes steps of the sizes in the plan, from the start on. Call it before the first step.
  void follow(StepPlan plan);

  /// Turns steps, from the start on, into iterations that bring an undamped() body to rest at one
  /// moment after another; time() is that of its bones and surroundings. Call it before the first
  /// step. Throws bad input for the reference stepper.
  void relax(LoadSteps steps);
  /// Changes groups as the body moves from now on. Throws bad input for the reference stepper.
  void enable_dynamic_groups(const DynamicOptions& options);

  /// Moves the bones so from now on; at the present moment the pose should be the same. Throws bad
  /// input where there are groups of particles, static or dynamic: they are made for one motion.
  void play(Motion motion);

  /// Makes steps of this size, s, which is below the limit, from now on. Throws bad input where
  /// they follow a plan or are iterations, and for a size that is not positive.
  void set_time_step(double step);
  /// Gives the body this material, a variant of its own, from now on: particles, bonds and what has
  /// become of them stay. Throws bad input for another model, size or mass of particles, other
  /// neighbors at rest, and where there are groups of particles.
  void set_material(const Material& material);
  /// Surrounds the body with another world from now on. Throws bad input where there are groups of
  /// particles.
  void set_world(std::shared_ptr<const World> world);

  // Motion.

  /// Advances by one step, or so many, between which nothing is read. Throws Error (unstable) that
  /// names step, particle, cause and a cure when a value is not finite or a particle moves over
  /// 0.25 r relative to its bone in the step (one without a bone: relative to its previous motion).
  /// The particles stay where they were before the step; bonds that broke in it stay broken.
  void step() { advance(1); }
  void advance(std::int64_t steps);
  /// Particles that moved too far in the step that failed, in the order of the particles.
  const std::vector<Offender>& offenders() const;

  // The present moment.

  double time() const;  ///< s
  std::int64_t steps() const;
  const Body& body() const;
  const Stepping& stepping() const;
  const Particles& particles() const;
  const Pose& pose() const;  ///< until the next step

  const Forces& forces();
  /// particles() and forces() without a copy, for a caller who keeps them; both are found anew when
  /// they are asked for again.
  Particles take_particles();
  Forces take_forces();
  /// Memory of earlier ones, for those that are found next: spares the system from clearing new.
  void reuse(Particles particles, Forces forces);

  /// The size of the resultant() of a body that is brought to rest; else not-a-number.
  Unbalanced unbalanced();

  /// Kinetic energy and dissipation are evaluated at the moment of the positions, so that the
  /// balance closes to second order in the step.
  Energies energies();

  // What has become of bonds, groups and lists, and of a body that is brought to rest.

  /// Way to rest; none of a body that moves.
  const Relaxation* relaxation() const;
  /// Energy lost where particles joined groups, J; part of the dissipation.
  double lost_by_merging() const;
  std::int64_t regroupings() const;
  /// What a guard's limits of speed have taken (frame_guard.h).
  const LimitedSpeeds& limited() const;
  /// How often neighbor lists were built; zeros for the cell stepper.
  ListCounts list_counts() const;

  /// Broken bonds of each particle, in the order of the particles; none for the paper's model,
  /// which has no bonds.
  std::vector<std::int32_t> broken_bonds() const;

  /// The rest length of each bond now, m, 0 once broken: by entry of `nearest`, then of `second`,
  /// the neighbors at rest by id, ascending. Zeros for a material without bonds.
  std::vector<double> rest_of_bonds(const NeighborLists& nearest,
                                    const NeighborLists& second) const;

  // Reactions.

  /// The force of the body on each obstacle of its world at the present moment, about its frame.
  std::vector<Reaction> reactions_of_obstacles();
  /// The force of each support and load of its world on the body at the present moment, about its
  /// pivot. The inertia of what supports hold is not part of it.
  std::vector<Reaction> support_reactions();
  std::vector<Reaction> load_reactions();
  /// The force of the body on each bone at the present moment, about its head.
  BoneReactions reactions_of_bones();

  // States.

  /// The state from which a simulation continues with the same bits, on any number of threads.
  SimulationState save() const;
  /// Continues from that moment of a simulation of the same body and stepping; the motion may be
  /// another. Throws bad input for a state that does not fit.
  void restore(const SimulationState& state);

 private:
  friend class GuardedSteps;
  struct Impl;

  void change(Body body, const char* what);
  bool try_advance(std::int64_t steps);
  void evaluate();
  double mass(std::size_t i) const;
  std::int64_t steps_of_one_size(std::int64_t most) const;
  bool make_steps(std::int64_t count);
  void add(const StepSums& sums);
  bool relax_once();
  void check_groups();
  void take(NewGroups made);
  void move_in(Grouping grouping);
  const TimedPose& moment() const;
  void forget_read() const;
  void set_step(double step);
  void change_step(double step);
  void add_to_velocities(double by, const std::function<Vec3(std::size_t i)>& gain);
  Vec3 acceleration(std::size_t i) const;

  std::unique_ptr<Impl> its_;
};

}  // namespace sinew
