// SPDX-License-Identifier: GPL-3.0-or-later
// Groups in motion, for the list stepper. A group of n particles at c + F X, with sum X = 0, has
//
//     n m c'' = sum f_i,   F'' sum m X X^T = sum f_i X_i^T,
//
// which restricts the motion of its particles to affine ones without doing work: momentum is kept,
// and an even strain passes through its faces. f_i is zero but on the rim (grouping.h), where the
// kernel computes it, and but for gravity and bones, which are summed over a sample of blocks.
//
// Blocks of particles within a group are idle: a step leaves them out. Those that its neighbors
// read are placed before each step, all others when somebody asks for them.
//
//     groups.place(state);                       // before a step
//     step.grouped = groups.arrays();
//     groups.sum(kernel, step, units, by);
//     groups.bound(units, false, motions, totals);
//     groups.advance();                          // after it, unless it failed
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <sinew/core/simulation_state.h>
#include <sinew/physics/forces.h>
#include <sinew/physics/hierarchy/grouping.h>
#include <sinew/physics/hierarchy/quadrature.h>
#include <sinew/physics/kernel/kernel.h>
#include <sinew/physics/lists/block_state.h>
#include <sinew/physics/lists/bond_lists.h>

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
  Groups() = default;
  Groups(std::shared_ptr<const Body> body, double mass);

  bool any() const { return !motions_.empty(); }
  /// The particles `id` in the kernel's order.
  void set_order(std::span<const std::int32_t> id);
  /// Of these particles: least squares.
  void begin(const BlockState<Real>& state, const Units& units);

  /// Puts the particles of the groups at their places, but for those that nobody reads in a step.
  void place(BlockState<Real>& state, const Units& units);
  /// Those of some pieces; of all.
  void show(BlockState<Real>& state, const Units& units, std::span<const std::uint32_t> pieces);
  void show_all(BlockState<Real>& state, const Units& units);

  /// Whether the particle at place k is in an idle block.
  bool is_idle(std::size_t k) const { return any() && role_[k / block] == kernel::idle; }
  /// By piece: 1 where all blocks are idle.
  const std::vector<std::uint8_t>& idle_pieces() const { return idle_pieces_; }
  /// What a step reads of idle blocks through these bonds, for all steps; through the lists of some
  /// pieces, from now on.
  void read_through(const BondLists<Real>& bonds, bool two_deep);
  void read_through(const kernel::Lists* lists, std::span<const std::uint32_t> pieces);
  kernel::Grouped<Real> arrays();

  /// From what the kernel gathered in a step, and the bones' forces on idle blocks.
  void sum(const kernel::Functions<Real>& kernel, const kernel::Step<Real>& step,
           const Units& units, const GroupStep& by);
  const GroupSums& sums() const { return sums_; }
  /// Raises the speeds in the totals of pieces to those of grouped particles in the step.
  void bound(const Units& units, bool drift_first, const kernel::PieceMotion<Real>* motions,
             std::span<kernel::Totals> totals) const;
  void advance();
  /// Throws Error (unstable) where a group is squeezed so much that more particles than the layers
  /// take for neighbors would exert forces on each other.
  void check_stretch() const;

  /// Fills what keeps the groups together, from all other forces and gravity (m/s^2). `caller`: of
  /// each place, that in `forces`.
  void constrain(Forces& forces, const std::vector<std::uint32_t>& caller,
                 const Vec3& gravity) const;

  void save(SimulationState& state) const;
  void restore(const SimulationState& state);

 private:
  static constexpr std::size_t block = BlockState<Real>::block;

  struct Motion {
    Vec3 c = Vec3::Zero(), v = Vec3::Zero();  ///< m, m/s
    Mat3 F = Mat3::Identity(), V = Mat3::Zero();
  };
  /// Constant.
  struct Shape {
    Vec3 center = Vec3::Zero();   ///< m
    double size = 0;              ///< particles
    Mat3 inverse = Mat3::Zero();  ///< of sum X X^T, 1/m^2
    double extent = 0;            ///< root mean square of X, m
    double idle = 0;              ///< particles in idle blocks
    Vec3 moment = Vec3::Zero();   ///< of those, sum of X, m
  };
  /// Places [begin, end) in the kernel's order, all of one group; and the row of the first.
  struct Run {
    std::uint32_t begin, end;
    std::int32_t group;
    std::int64_t row = 0;
  };
  /// Of accelerations.
  struct Sum {
    Vec3 f = Vec3::Zero();
    Mat3 fX = Mat3::Zero();

    void add(const Vec3& force, const Vec3& X) { f += force, fX += force * X.transpose(); }
    void add(const double* moments);
  };
  /// Around the places at rest of a group's particles in a piece.
  struct PieceBox {
    std::uint32_t piece;
    std::int32_t group;
    Box box;
  };

  void find_shapes();
  void find_roles();
  void find_boxes();
  void find_samples();
  template <class Visit>
  void for_each_run(std::size_t begin, std::size_t end, const Visit& visit) const;
  static void append(const Run& run, std::vector<Run>& runs);
  void mark_read(std::ptrdiff_t first, std::ptrdiff_t last);
  void find_steady();
  void put(const Run& run, BlockState<Real>& state, const Units& units) const;
  Sum sum_of(const Run& run, const kernel::Functions<Real>& kernel) const;
  void add_bones(const kernel::Functions<Real>& kernel, const kernel::Step<Real>& step,
                 std::vector<Sum>& all, std::vector<Sum>& damping);
  Vec3 place_at_rest(std::size_t k) const { return {X_[0][k], X_[1][k], X_[2][k]}; }

  std::shared_ptr<const Body> body_;
  double mass_ = 0;
  double least_stretch_ = 0;
  std::vector<Shape> shapes_;
  std::vector<Motion> motions_, next_;
  std::vector<std::int32_t> group_;               ///< by place in the kernel's order; -1: free
  std::array<std::vector<double>, 3> X_;          ///< by place, m
  std::array<std::vector<Real>, 3> X_of_kernel_;  ///< by place, padded, m
  std::vector<std::int32_t> id_;                  ///< by place
  std::vector<std::int32_t> role_;                ///< by block: kernel::Role, or a row
  std::vector<std::uint8_t> asleep_;              ///< by block
  std::vector<std::uint8_t> whole_;               ///< by block
  std::vector<std::uint8_t> idle_pieces_;         ///< by piece
  std::vector<Run> rim_;                          ///< of the blocks with rows
  std::vector<Run> steady_;                       ///< placed before each step
  std::vector<std::uint8_t> always_;              ///< by block: idle, but read in every step
  bool more_are_read_ = true;
  std::vector<std::int64_t> shown_;  ///< by piece: when all was last placed
  std::int64_t moment_ = 0;
  std::vector<PieceBox> boxes_;
  std::array<std::vector<Real>, 3> acceleration_;
  Quadrature samples_;
  std::vector<Run> sampled_;  ///< samples [begin, end) of a group
  GroupSums sums_;
};

}  // namespace sinew
