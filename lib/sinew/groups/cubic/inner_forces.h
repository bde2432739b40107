// SPDX-License-Identifier: GPL-3.0-or-later
// What bonds exert within groups that move by cubics of the place. The bonds of one direction are
// apart by a square polynomial of the place, and do work on the terms of the motion: sums over them
// are taken from samples, with weights that make sums of products of two such polynomials exact.
// Bonds to what the kernel computes are summed one by one, as it does: momentum is kept to
// rounding. Second neighbors that touch repel each other by eq. 1. Eq. 2 is linear, so it is a
// matrix; those that touch do not count there.
//
//     const InnerForces<Real> inner(body, lattice, bonds, particles);
//     inner.add(kernel, motions, sums);
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <sinew/groups/affine/affine_forces.h>
#include <sinew/groups/cubic/polynomials.h>
#include <sinew/groups/cubic/quadrature.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/block_state.h>
#include <sinew/lists/bond_lists.h>

namespace sinew {

/// A group's, m and m/s, by terms of the place in its frame.
struct GroupMotion {
  Coefficients x = Coefficients::Zero(), v = Coefficients::Zero();
};

/// Sums of forces on particles of a group (N), times the terms of their places.
struct GroupForces {
  Coefficients force = Coefficients::Zero(), drag = Coefficients::Zero();  ///< all; of eq. 2
};

/// Particles of groups, by place in the kernel's order.
struct InnerParticles {
  std::span<const std::int32_t> id, group;    ///< group -1: free
  std::array<std::span<const double>, 3> at;  ///< in the frame of the group
  std::span<const std::uint8_t> idle;         ///< one per block: the kernel leaves it out
  std::vector<Mat3> frames;                   ///< frame of differences at rest, one per group, 1/m
  std::vector<std::uint8_t> cubic;            ///< one per group
};

template <class Real>
class InnerForces {
 public:
  InnerForces() = default;
  /// The bonds must stay as they are.
  InnerForces(const Body& body, const AffineForces& lattice, const BondLists<Real>& bonds,
              const InnerParticles& particles);

  /// Adds those on idle particles of cubic groups. In parallel.
  void add(const kernel::Functions<Real>& kernel, std::span<const GroupMotion> motions,
           std::span<GroupForces> sums) const;
  /// On one idle block alone.
  GroupForces on(const BondLists<Real>& bonds, const InnerParticles& particles, std::size_t block,
                 const GroupMotion& motion) const;

 private:
  static constexpr std::size_t block = BlockState<Real>::block;

  /// Bonds of one direction in a group: their near ends in vectors, [begin, end).
  struct Task {
    std::int32_t group;
    std::uint32_t site;
    bool across;  ///< to what the kernel computes
    std::size_t begin, end;
  };
  /// Constant.
  struct Group {
    bool cubic = false;
    std::array<Growth, near_sites> growth;  ///< one per site
    Eigen::Matrix<double, cubic_terms, cubic_terms> drag;
  };
  struct Reach;
  struct Found;
  struct Ends;

  Reach reach_of(const BondLists<Real>& bonds, const InnerParticles& of, std::size_t b) const;
  double factor(const InnerParticles& of, std::size_t near, std::size_t far) const;
  Found found_in(const BondLists<Real>& bonds, const InnerParticles& of, std::size_t begin,
                 std::size_t end) const;
  using Counts = std::vector<std::size_t>;  ///< numbers of bonds, by group and site
  using Take = std::function<bool(std::size_t of, std::size_t nth)>;
  static bool is_inner(const InnerParticles& of, std::size_t b) {
    return of.idle[b] != 0 && of.cubic[static_cast<std::size_t>(of.group[b * block])] != 0;
  }
  std::vector<Ends> ends_within(const BondLists<Real>& bonds, const InnerParticles& of,
                                const std::vector<Counts>& before, const Take& take) const;
  void sample(const BondLists<Real>& bonds, const InnerParticles& of,
              const std::vector<Found>& found);
  void add_across(const BondLists<Real>& bonds, const InnerParticles& of);
  void append(Task task, const Ends& ends, std::span<const double> weights);
  double stiffness_of(std::uint32_t site) const;
  double push_of(std::uint32_t site) const;

  const Body* body_ = nullptr;
  Points site_;                    ///< m
  std::vector<int> site_of_kind_;  ///< site of each kind of bond
  std::uint32_t leading_ = 0;      ///< one of each site and its opposite
  std::vector<Group> groups_;
  std::vector<Task> tasks_;
  std::array<std::vector<double>, 3> at_;  ///< places of near ends, in their group's frame
  std::vector<double> weight_, contact_;   ///< on the stiffness, and on contacts; 0: padding
};

}  // namespace sinew
