// SPDX-License-Identifier: GPL-3.0-or-later
// Steps as the paper describes them, its cells sorted again in every step: the readable reference.
//
//     CellStepper stepper(body, stepping, particles);
//     stepper.advance(moments, sums);
#pragma once

#include <memory>
#include <optional>
#include <span>

#include <sinew/body/solid.h>
#include <sinew/body/step_plan.h>
#include <sinew/rig/pose.h>
#include <sinew/stepping/detail/rigid_references.h>
#include <sinew/stepping/stepper.h>
#include <sinew/world/sliding_contacts.h>
#include <sinew/world/world.h>

namespace sinew {

class CellStepper final : public Stepper {
 public:
  /// Throws bad input for groups of particles, which it has none of.
  CellStepper(std::shared_ptr<const Body> body, const Stepping& stepping, Particles particles);

  void advance(std::span<const TimedPose> begins, std::vector<StepSums>& sums) override;
  void set_step(double step) override { stepping_.step = step; }
  void allow_moves(double radii) override { max_radii_ = radii; }
  Balance evaluate(const TimedPose& now, Forces& forces) override;
  void read(const TimedPose& now, Particles& particles) override;
  WorldReactions reactions() const override {
    WorldReactions all{reactions_, of_pins_, of_supports_, of_loads_};
    all.add(of_rigid_);
    return all;
  }
  std::vector<std::int32_t> broken_bonds() const override;
  void read(BondRest& rest) const override;
  void save(SimulationState& state) override;
  void restore(const SimulationState& state) override;

 private:
  struct Particle {
    Vec3 position, velocity;
  };

  StepSums step(const TimedPose& now);
  void find_forces(const TimedPose& now);
  void find_world_forces(const TimedPose& now);
  void find_loads(const WorldNow& now);
  void find_friction();
  void add_rigid_damping(const TimedPose& now);
  void hold_back(const WorldNow& now, const Pose& pose);
  void hold(const TimedPose& now);
  double stored_in_pairs();
  double mass(std::size_t i) const;
  Vec3 acceleration(std::size_t i) const;
  Vec3 velocity_now(std::size_t i) const;
  void add_world(StepSums& sums) const;
  StepSums sums() const;
  void move(std::size_t i, double kick);
  Vec3 moved(std::size_t i, const Particle& before, const Pose& pose) const;
  bool sound(std::size_t i, const Particle& before, const Pose& pose) const;
  Failure take_back(const Pose& pose);

  std::shared_ptr<const Body> body_;
  Stepping stepping_;
  Particles particles_;
  std::optional<Solid> solid_;  ///< solid of materials whose forces depend on the neighbors at rest
  Forces forces_;
  MovingInDouble before_;  ///< the step
  std::vector<ParticleWorld> around_;
  Points muscle_, load_, friction_;
  SlidingContacts sliding_;
  bool stepping_now_ = false;  ///< the forces are those of a step, not only looked at
  std::vector<LoadNow> loads_;
  std::vector<Reaction> reactions_;  ///< reactions of obstacles
  std::vector<Reaction> of_pins_;    ///< on bones
  std::vector<Reaction> of_supports_, of_loads_;
  RigidReferences references_;
  std::int64_t steps_ = 0;
  WorldReactions of_rigid_;         ///< damping
  double rigid_power_ = 0;          ///< power of what that is relative to, W
  std::vector<std::size_t> held_;   ///< index of the particle of each pin of the world
  std::vector<bool> is_held_;       ///< empty without pins
  std::vector<std::size_t> place_;  ///< place of a particle, by id; empty without a world
  bool kicked_ = false;  ///< velocities are half a step behind positions (velocity Verlet)
  double max_radii_ = max_radii_per_step;
};

}  // namespace sinew
