// SPDX-License-Identifier: GPL-3.0-or-later
// Groups in motion, for the list stepper. A group's particles are at x_i = sum_k x_k p_k(X_i),
// where p_k are the terms of polynomials of the place at rest (polynomials.h), in a frame in which
// the group is about 1 large in each direction:
//
//     sum_k x_k'' sum_i m p_k p_l = sum_i f_i p_l,
//
// which restricts the motion of its particles to such ones without doing work: momentum is kept,
// and an even strain passes through its faces. The kernel computes f_i on the rim (grouping.h). In
// affine groups it is zero elsewhere but in the skin, where it follows from the motion
// (affine_forces.h); in cubic ones it follows from the motion everywhere (inner_forces.h). Gravity
// and bones, which are summed over a sample of blocks, come to that.
//
// Where the particles are and which of them a step computes is in detail/group_layout.h, what moves
// them in detail/group_motions.h, and how far they may go in detail/group_limits.h.
//
//     groups.watch(lists.arrays(), lists.take_changed(), bonds, meets);
//     groups.place(state, units);                // before a step
//     groups.activate(state, units);
//     step.grouped = groups.arrays();
//     groups.step(bonds, step, units, by, meets, totals);
//     groups.advance();                          // after it, unless it failed
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/body/forces.h>
#include <sinew/body/grouping.h>
#include <sinew/core/simulation_state.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/block_state.h>
#include <sinew/lists/bond_lists.h>
#include <sinew/lists/near_pieces.h>

namespace sinew {

/// How a step advances a group, s.
struct GroupStep {
  double kick = 0, drift = 0, middle = 0;
  bool drift_first = false;
  Vec3 gravity = Vec3::Zero();  ///< m/s^2
};

/// The ledger's part of what bones exert on idle blocks, W.
struct GroupSums {
  double power = 0, lost = 0;
};

template <class Real>
class Groups {
 public:
  /// None.
  Groups();
  /// Groups of the body's grouping, if it has any. `mass`: of a particle, kg.
  Groups(std::shared_ptr<const Body> body, double mass, const kernel::Functions<Real>& kernel);
  Groups(Groups&&) noexcept;
  Groups& operator=(Groups&&) noexcept;
  ~Groups();

  bool any() const { return impl_ != nullptr; }
  /// Takes the particles `id` in the kernel's order, with these bonds among them. `two_deep`:
  /// forces depend on the neighbors of neighbors.
  void set_order(std::span<const std::int32_t> id, const BondLists<Real>& bonds, bool two_deep);
  /// Takes the motions that fit the particles best: least squares.
  void begin(const BlockState<Real>& state, const Units& units);
  /// Takes the new lists of some pieces: what a step reads through them, and which idle blocks they
  /// pair with particles of others. `meets`: of a piece, whether it may.
  void watch(const kernel::Lists* lists, std::span<const std::uint32_t> pieces,
             const BondLists<Real>& bonds, const std::function<bool(std::size_t)>& meets);
  /// Puts the particles of the groups at their places, but for those that nobody reads in a step.
  void place(BlockState<Real>& state, const Units& units);
  /// Puts all there.
  void show_all(BlockState<Real>& state, const Units& units);
  /// Wakes the idle blocks that are touched at this moment, and no others.
  void activate(BlockState<Real>& state, const Units& units);
  /// What neighbor lists see; valid as long as state and units are.
  GroupedParticles seen(BlockState<Real>& state, const Units& units);
  /// Whether the particle at place k is in an idle block.
  bool is_idle(std::size_t k) const;
  kernel::Grouped<Real> arrays();

  /// Finds the next motions from what the kernel gathered in a step, and the bones' forces on idle
  /// blocks; raises the speeds in the totals of pieces to those of grouped particles. `meets`: of a
  /// piece, whether particles of others are near. Throws Error (unstable) where a group is
  /// squeezed or stretched beyond what it knows of.
  void step(const BondLists<Real>& bonds, const kernel::Step<Real>& step, const Units& units,
            const GroupStep& by, const std::function<bool(std::size_t)>& meets,
            std::span<kernel::Totals> totals);
  GroupSums sums() const;
  void advance();
  /// Adds, to the cell of each particle on which forces were gathered in the last step, what of its
  /// acceleration the group does not follow. `cell`: by id.
  void add_constrained(std::span<const std::int32_t> cell, const Units& units,
                       std::span<ConstrainedCell> constrained) const;
  /// Fills what keeps the groups together, from all other forces and gravity (m/s^2). `caller`: of
  /// each place, that in `forces`.
  void constrain(Forces& forces, const std::vector<std::uint32_t>& caller,
                 const Vec3& gravity) const;

  void save(SimulationState& state) const;
  void restore(const SimulationState& state);

 private:
  struct Impl;

  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew
