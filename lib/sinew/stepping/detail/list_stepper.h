// SPDX-License-Identifier: GPL-3.0-or-later
// Steps with the vectorized kernel and neighbor lists.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <sinew/body/solid.h>
#include <sinew/body/step_plan.h>
#include <sinew/groups/groups.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/block_state.h>
#include <sinew/lists/bond_lists.h>
#include <sinew/lists/bone_slots.h>
#include <sinew/lists/list_counts.h>
#include <sinew/lists/particle_layout.h>
#include <sinew/lists/strain_lists.h>
#include <sinew/lists/verlet_lists.h>
#include <sinew/stepping/detail/rigid_brakes.h>
#include <sinew/stepping/detail/surroundings.h>
#include <sinew/stepping/stepper.h>

namespace sinew {

template <class Real>
class ListStepper final : public Stepper {
 public:
  /// Frees the motion of the particles as soon as it is in the kernel's layout: bonds and lists
  /// take memory too.
  ListStepper(std::shared_ptr<const Body> body, const Stepping& stepping, Particles& particles,
              kernel::InstructionSet instructions);

  void advance(std::span<const TimedPose> begins, std::vector<StepSums>& sums) override;
  void set_step(double step) override;
  void allow_moves(double radii) override { max_radii_ = radii; }
  Balance evaluate(const TimedPose& now, Forces& forces) override;
  void read(const TimedPose& now, Particles& particles) override;
  WorldReactions reactions() const override;
  std::vector<std::int32_t> broken_bonds() const override;
  void read(BondRest& rest) const override { bonds_.read(layout_.id(), layout_.units(), rest); }
  ListCounts counts() const override;
  void save(SimulationState& state) override;
  void restore(const SimulationState& state) override;

  /// Particles in groups relax nothing.
  bool relaxes() const override { return !groups_.any(); }
  StepSums try_step(const TimedPose& now, double keep) override;
  void accept() override;
  void halt() override { layout_.now.halt(); }
  void place(const Points& positions, Move move) override;

  bool has_groups() const override { return true; }
  void regroup() override;
  void fit_groups() override { groups_.begin(layout_.now, layout_.units()); }
  std::vector<ConstrainedCell> constrained_cells(std::span<const std::int32_t> cell,
                                                 std::size_t cells) const override;

 private:
  static constexpr int block = BlockState<Real>::block;
  /// Below this many of them a barrier costs more than the work.
  static constexpr std::size_t particles_per_thread = 8192;
  static constexpr std::size_t pieces_per_thread =
      particles_per_thread / (kernel::blocks_per_piece * BlockState<Real>::block);
  static constexpr std::size_t pieces_at_a_time = 4;  ///< where some take longer than others

  kernel::Bindings<Real> bindings() const;
  kernel::Step<Real> job();
  void on_all_pieces(const std::function<void(std::size_t, std::size_t)>& run);
  void hold(const TimedPose& now);
  void follow_units();
  kernel::Step<Real> begin(const TimedPose& now, Points* world_forces, bool whole);
  void find_deformation(const kernel::Step<Real>& now);
  bool meets_none(const kernel::Step<Real>& now, std::size_t piece) const;
  void find_flow(const kernel::Step<Real>& now);
  void move_groups(const kernel::Step<Real>& now);
  StepSums run(kernel::Step<Real> now, const Pose& pose);
  Imbalance imbalance() const;

  void update_lists();
  double travel_of_step() const;
  bool order_check_due();
  void sort();
  void add_moved();
  void make_lists();
  void find_slots();
  StepSums sums_of_totals() const;
  Failure failure(const Pose& pose);
  Vec3 relative_velocity(const Pose& pose, std::size_t k) const;

  std::shared_ptr<const Body> body_;
  Stepping stepping_;
  double mass_;    ///< mass of a particle of the material's density, kg
  double extent_;  ///< extent of the body at rest, m
  kernel::Functions<Real> kernel_;
  kernel::PairLaw law_;
  kernel::LawFunctions<Real> work_;  ///< functions of the material's law
  ParticleLayout<Real> layout_;
  BoneSlots<Real> slots_;
  BondLists<Real> bonds_;
  StrainLists<Real> strain_;
  Surroundings<Real> surroundings_;
  Groups<Real> groups_;
  RigidBrakes<Real> brakes_;
  WorldReactions of_brakes_;               ///< reactions in the last probe
  bool counted_ = false;                   ///< the neighbors of all particles, in the present order
  std::vector<std::uint8_t> bonds_count_;  ///< one per piece: its counts are of bonds alone
  std::vector<double> moved_;          ///< distance by pins, by piece, since the lists followed, m
  std::vector<Real> masses_;           ///< over mass_, padded at the end; empty: 1 each
  std::vector<std::uint8_t> careful_;  ///< one per vector of particles; see kernel::Step
  std::vector<Real> inverse_count_;    ///< padded; empty unless damping acts pair by pair
  std::vector<kernel::BoneNow<Real>> bones_;  ///< at the present pose
  std::int64_t steps_ = 0;
  bool kicked_ = false;  ///< velocities are half a step behind positions (velocity Verlet)

  VerletLists<Real> lists_;
  /// Differences per block in the outer list; initially those of a packed body.
  double mean_when_sorted_ = 45;
  std::int64_t order_checked_ = -1;  ///< the step before which it was last checked
  std::int64_t sorts_ = 0;
  double sorting_ = 0;  ///< s
  std::vector<kernel::Totals> totals_;
  bool stepped_ = false;  ///< and the lists have not followed
  double max_radii_ = max_radii_per_step;
};

}  // namespace sinew
