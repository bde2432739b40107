// SPDX-License-Identifier: GPL-3.0-or-later
// Groups in motion, for the list stepper. A group of n particles at c + F X, with sum X = 0, has
//
//     n m c'' = sum f_i,   F'' sum m X X^T = sum f_i X_i^T,
//
// which restricts the motion of its particles to affine ones without doing work: momentum is kept,
// and an even strain passes through its faces. f_i is zero but on the rim (grouping.h), where the
// kernel computes it, and in the skin, where it follows from F (affine_forces.h); but for gravity
// and bones, which are summed over a sample of blocks.
//
// Blocks of particles within a group are idle: a step leaves them out. Those that its neighbors
// read are placed before each step, all others when somebody asks for them. Those that particles of
// others may touch are watched, and wake in steps in which they are touched.
//
//     groups.watch(lists.arrays(), lists.take_changed(), ...);
//     groups.place(state, units);                // before a step
//     groups.wake(state);
//     step.grouped = groups.arrays();
//     groups.sum(kernel, step, units, by);
//     groups.bound(units, false, parts, totals);
//     groups.advance();                          // after it, unless it failed
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <sinew/core/simulation_state.h>
#include <sinew/physics/forces.h>
#include <sinew/physics/hierarchy/affine_forces.h>
#include <sinew/physics/hierarchy/grouping.h>
#include <sinew/physics/hierarchy/quadrature.h>
#include <sinew/physics/kernel/kernel.h>
#include <sinew/physics/lists/block_state.h>
#include <sinew/physics/lists/bond_lists.h>
#include <sinew/physics/lists/near_pieces.h>

namespace sinew {

/// What keeps the particles of a cell of the body in their groups.
struct HeldCell {
  double squares = 0;  ///< sum of squares of accelerations that their groups do not follow, m^2/s^4
  double count = 0;    ///< of particles
};

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
  /// By piece: the group that all of its particles are of, or -1.
  const std::vector<std::int32_t>& group_of_pieces() const { return of_piece_; }
  /// How a piece of one group moves, in the kernel's units.
  PieceNow piece_now(std::size_t piece, const Units& units) const;
  /// F of each.
  std::vector<Mat3> stretches() const;
  /// What a step reads of idle blocks through these bonds, for all steps. `two_deep`: forces depend
  /// on the neighbors of neighbors.
  void read_through(const BondLists<Real>& bonds, bool two_deep);
  /// What it reads through the new lists of some pieces, from now on, and which idle blocks they
  /// pair with particles of others. `meets`: of a piece, whether it may.
  void watch(const kernel::Lists* lists, std::span<const std::uint32_t> pieces,
             const BondLists<Real>& bonds, const std::function<bool(std::size_t)>& meets);
  /// Wakes the blocks that are touched at this moment, and no others.
  void wake(BlockState<Real>& state, const Units& units);
  kernel::Grouped<Real> arrays();

  /// From what the kernel gathered in a step, and the bones' forces on idle blocks.
  void sum(const kernel::Functions<Real>& kernel, const kernel::Step<Real>& step,
           const Units& units, const GroupStep& by);
  const GroupSums& sums() const { return sums_; }
  /// Raises the speeds in the totals of pieces to those of grouped particles in the step.
  void bound(const Units& units, bool drift_first, const kernel::Parts<Real>& parts,
             std::span<kernel::Totals> totals) const;
  void advance();
  /// Adds, to the cell of each particle on which forces were gathered in the last step, what of its
  /// acceleration the group does not follow. `cell`: by id.
  void add_held(std::span<const std::int32_t> cell, const Units& units,
                std::span<HeldCell> held) const;
  /// Throws Error (unstable) where a group is squeezed so much that more particles than the layers
  /// take for neighbors would exert forces on each other, or stretched so much that fewer would.
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
    AffineMoments skin;           ///< of those
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
  /// Around the places at rest of a group's particles in a part of a piece.
  struct PieceBox {
    std::uint32_t piece, part;
    std::int32_t group;
    Box box;
  };
  /// Of the skin.
  struct SkinBlock {
    std::uint32_t block;
    AffineMoments moments;
  };
  /// Particles of other groups, or free ones, at a difference from those of an idle block.
  struct Watched {
    std::uint32_t block;
    std::int32_t difference;
  };

  void find_shapes();
  void find_roles();
  void find_skins(std::int32_t rows);
  void find_pieces(std::size_t pieces);
  void find_boxes();
  void find_samples();
  template <class Visit>
  void for_each_run(std::size_t begin, std::size_t end, const Visit& visit) const;
  static void append(const Run& run, std::vector<Run>& runs);
  void mark_read(std::ptrdiff_t first, std::ptrdiff_t last);
  void mark_read(std::size_t b, const BondLists<Real>& bonds) {
    for_each_reach(b, bonds, [&](auto first, auto last) { mark_read(first, last); });
  }
  /// Calls visit(first, last) for the particles that the block's bonds read.
  template <class Visit>
  static void for_each_reach(std::size_t b, const BondLists<Real>& bonds, const Visit& visit) {
    for (std::uint32_t e = bonds.first[b]; e < bonds.first[b + 1]; ++e) {
      const std::uint32_t lanes = bonds.entries[e].lanes >> kernel::rest_lanes;
      if (lanes == 0) continue;
      const std::ptrdiff_t from =
          static_cast<std::ptrdiff_t>(b * block) + bonds.entries[e].difference;
      visit(from + std::countr_zero(lanes), from + 31 - std::countl_zero(lanes));
    }
  }
  void mark_lists(std::size_t block, const kernel::Lists& lists);
  bool may_idle(std::size_t b) const { return idle_[b] != 0; }
  void watch_piece(const kernel::Lists& lists, std::size_t piece);
  void rouse(std::uint32_t block, const BondLists<Real>& bonds);
  bool touches(const Watched& watched, BlockState<Real>& state, double range2) const;
  void add_awake(const kernel::Functions<Real>& kernel, const kernel::Step<Real>& step,
                 std::vector<Sum>& all, std::vector<Sum>& damping, std::vector<Shape>& shapes);
  void find_steady();
  AffineSum skin_of(const Shape& shape, const Motion& motion) const;
  AffineSum drag_of(const Shape& shape, const Motion& motion) const;
  void put(const Run& run, BlockState<Real>& state, const Units& units) const;
  Sum sum_of(const Run& run, const kernel::Functions<Real>& kernel) const;
  void add_bones(const kernel::Functions<Real>& kernel, const kernel::Step<Real>& step,
                 std::vector<Sum>& all, std::vector<Sum>& damping);
  Vec3 place_at_rest(std::size_t k) const { return {X_[0][k], X_[1][k], X_[2][k]}; }

  std::shared_ptr<const Body> body_;
  double mass_ = 0;
  StretchRange stretch_{};
  std::optional<AffineForces> affine_;
  std::vector<Shape> shapes_;
  std::vector<Motion> motions_, next_;
  std::vector<Sum> accelerations_;                ///< of the last step: of c, and of F; m/s^2
  std::vector<std::int32_t> group_;               ///< by place in the kernel's order; -1: free
  std::array<std::vector<double>, 3> X_;          ///< by place, m
  std::array<std::vector<Real>, 3> X_of_kernel_;  ///< by place, padded, m
  std::vector<std::int32_t> id_;                  ///< by place
  std::vector<std::int32_t> role_;                ///< by block: kernel::Role, or a row
  std::vector<std::uint8_t> asleep_;              ///< by block
  std::vector<std::uint8_t> whole_;               ///< by block
  std::vector<std::int32_t> of_piece_;            ///< by piece: its group, or -1
  std::vector<std::uint32_t> box_of_;             ///< by piece: of a group, its place in boxes_
  std::vector<Run> rim_;                          ///< of the blocks with rows
  std::vector<SkinBlock> skins_;
  std::vector<std::int32_t> skin_at_;          ///< by block: its place there, or -1
  std::int32_t rows_ = 0;                      ///< of rims; those of what is awake follow
  std::vector<std::uint8_t> idle_;             ///< by block: unless it is awake
  std::vector<std::vector<Watched>> watched_;  ///< by piece
  std::vector<std::uint32_t> watching_;        ///< pieces that have any, ascending
  std::vector<std::uint32_t> awake_;           ///< blocks, ascending
  bool two_deep_ = false;
  std::vector<Run> steady_;           ///< placed before each step
  std::vector<std::uint8_t> always_;  ///< by block: idle, but read in every step
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
