// SPDX-License-Identifier: GPL-3.0-or-later
// How groups move: what their particles feel, summed up, accelerates them, and their motion puts
// their particles at their places.
//
//     motions.place(state, units);                  // before a step
//     motions.sum(bonds, step, units, by);          // after it
//     motions.advance();                            // unless it failed
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <sinew/body/forces.h>
#include <sinew/core/simulation_state.h>
#include <sinew/groups/affine/affine_forces.h>
#include <sinew/groups/cubic/inner_forces.h>
#include <sinew/groups/cubic/pulled_sample.h>
#include <sinew/groups/detail/group_layout.h>
#include <sinew/groups/detail/group_shapes.h>
#include <sinew/groups/groups.h>
#include <sinew/kernel/kernel.h>

namespace sinew {

template <class Real>
class GroupMotions {
 public:
  GroupMotions() = default;
  /// All but the kernel's functions outlive it. `mass`: of a particle, kg.
  GroupMotions(const Body& body, double mass, const kernel::Functions<Real>& kernel,
               const std::vector<GroupShape>& shapes, GroupLayout<Real>& layout);

  const std::vector<GroupMotion>& now() const { return motions_; }
  /// What comes after the step that was summed up.
  const std::vector<GroupMotion>& next() const { return next_; }
  const GroupSums& sums() const { return sums_; }

  /// Follows a new order of the layout's particles, with these bonds among them.
  void set_order(const BondLists<Real>& bonds);
  /// Takes the motions that fit the particles best: least squares.
  void begin(const BlockState<Real>& state, const Units& units);
  /// Puts the particles of the groups at their places, but for those that nobody reads in a step.
  void place(BlockState<Real>& state, const Units& units);
  /// Puts there those of some pieces.
  void show(BlockState<Real>& state, const Units& units, std::span<const std::uint32_t> pieces);
  /// Makes room for what the kernel gathers, and says where.
  void put_into(kernel::Grouped<Real>& grouped);
  /// Finds the next motions from what the kernel gathered and the bones' forces on idle blocks.
  void sum(const BondLists<Real>& bonds, const kernel::Step<Real>& step, const Units& units,
           const GroupStep& by);
  void advance();

  void add_constrained(std::span<const std::int32_t> cell, const Units& units,
                       std::span<ConstrainedCell> constrained) const;
  void constrain(Forces& forces, const std::vector<std::uint32_t>& caller,
                 const Vec3& gravity) const;
  void save(SimulationState& state) const;
  void restore(const SimulationState& state);

 private:
  static constexpr std::size_t block = BlockState<Real>::block;

  /// Sums over particles in idle blocks.
  struct Idle {
    Terms terms = Terms::Zero();
    AffineMoments skin;  ///< skin of affine groups
  };
  /// An idle block with a part of the skin.
  struct SkinBlock {
    std::uint32_t block;
    AffineMoments moments;
  };
  /// What moves the groups in a step, by group: accelerations times terms in the kernel's units,
  /// the part of them that is damping, and what follows from the motion.
  struct Pulls {
    std::vector<Coefficients> all, damping;
    std::vector<Idle> idle;
    std::vector<GroupForces> inner;
  };

  void find_idle_terms();
  void find_skins();
  void find_sample();
  GroupMotion in_kernel(std::size_t group, const Units& units) const;
  void put(const GroupRun& run, BlockState<Real>& state, const Units& units) const;
  Coefficients sum_of(const GroupRun& run) const;
  void add_rims(Pulls& pulls) const;
  void add_bones(const kernel::Step<Real>& step, const Units& units, Pulls& pulls);
  void add_active(const BondLists<Real>& bonds, const kernel::Step<Real>& step, Pulls& pulls);
  void add_skins(Pulls& pulls) const;
  void add(const kernel::PullSums& found, std::size_t group, Pulls& pulls);
  void move(std::size_t group, const Coefficients& acceleration, const GroupStep& by);
  const GroupShape& shape_of(std::int32_t group) const {
    return (*shapes_)[static_cast<std::size_t>(group)];
  }

  const Body* body_ = nullptr;
  double mass_ = 0;
  kernel::Functions<Real> kernel_{};
  const std::vector<GroupShape>* shapes_ = nullptr;
  GroupLayout<Real>* layout_ = nullptr;
  std::optional<AffineForces> affine_;
  std::optional<InnerForces<Real>> inner_;
  PulledSample<Real> sample_;
  std::vector<Idle> idle_;  ///< one per group
  std::vector<SkinBlock> skins_;
  std::vector<std::int32_t> skin_at_;  ///< one per block: its place there, or -1
  std::vector<GroupMotion> motions_, next_;
  std::vector<Coefficients> accelerations_;        ///< accelerations of the last step, m/s^2
  std::array<std::vector<Real>, 3> acceleration_;  ///< what the kernel gathers, by row
  std::vector<std::int64_t> shown_;                ///< one per piece: when all was last placed
  std::int64_t moment_ = 0;
  GroupSums sums_;
};

}  // namespace sinew
