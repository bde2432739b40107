// SPDX-License-Identifier: GPL-3.0-or-later
// Steps as the paper describes them, with its cells sorted again in every step: the readable
// reference.
//
//     CellStepper stepper(body, stepping, particles);
//     const StepSums sums = stepper.step(pose);
#pragma once

#include <memory>
#include <optional>
#include <span>

#include <sinew/body/solid.h>
#include <sinew/body/step_plan.h>
#include <sinew/rig/pose.h>
#include <sinew/stepping/stepper.h>
#include <sinew/world/sliding_contacts.h>
#include <sinew/world/world.h>

namespace sinew {

class CellStepper {
 public:
  CellStepper(std::shared_ptr<const Body> body, const Stepping& stepping, Particles particles);

  /// Time (s) of the next call: surroundings change with it.
  void set_time(double time) { time_ = time; }
  /// Of the steps that follow, s; velocities stay as they are.
  void set_step(double step) { stepping_.step = step; }

  StepSums step(const Pose& pose);
  Balance evaluate(const Pose& pose, Forces& forces);
  void read(const Pose& pose, Particles& particles);
  /// Bonds broken so far, by particle; none for a body without bonds.
  std::vector<std::int32_t> broken_bonds() const;
  void read(BondRest& rest) const;
  /// As evaluated last; none without a world.
  std::vector<Reaction> reactions_of_obstacles() const { return reactions_; }
  /// On each bone; none without pins.
  std::vector<Reaction> reactions_of_pins() const { return of_pins_; }
  /// On the body; as evaluated last.
  std::vector<Reaction> of_supports() const { return of_supports_; }
  std::vector<Reaction> of_loads() const { return of_loads_; }

  void fit_groups() {}  ///< has none
  void save(SimulationState& state) const;
  void restore(const SimulationState& state);

 private:
  struct Particle {
    Vec3 position, velocity;
  };

  void find_forces(const Pose& pose);
  void find_world_forces(const Pose& pose);
  void find_loads(const WorldNow& now);
  void find_friction();
  void hold_back(const WorldNow& now, const Pose& pose);
  void hold(const Pose& pose);
  double stored_in_pairs();
  double mass(std::size_t i) const;
  Vec3 acceleration(std::size_t i) const;
  Vec3 velocity_now(std::size_t i) const;
  void add_world(StepSums& sums) const;
  StepSums sums() const;
  void advance(std::size_t i, double kick);
  Vec3 moved(std::size_t i, const Particle& before, const Pose& pose) const;
  bool sound(std::size_t i, const Particle& before, const Pose& pose) const;
  Failure take_back(const Pose& pose);

  std::shared_ptr<const Body> body_;
  Stepping stepping_;
  Particles particles_;
  std::optional<Solid> solid_;  ///< of materials whose forces depend on the neighbors at rest
  Forces forces_;
  MovingInDouble before_;  ///< the step
  double time_ = 0;
  std::vector<ParticleWorld> around_;
  Points muscle_, load_, friction_;
  SlidingContacts sliding_;
  bool stepping_now_ = false;  ///< the forces are those of a step, not only looked at
  std::vector<LoadNow> loads_;
  std::vector<Reaction> reactions_;  ///< of obstacles
  std::vector<Reaction> of_pins_;    ///< on bones
  std::vector<Reaction> of_supports_, of_loads_;
  std::vector<std::size_t> held_;   ///< index of the particle of each pin of the world
  std::vector<bool> is_held_;       ///< empty without pins
  std::vector<std::size_t> place_;  ///< of a particle, by id; empty without a world
  bool kicked_ = false;             ///< velocities are half a step ahead (velocity Verlet)
};

}  // namespace sinew
