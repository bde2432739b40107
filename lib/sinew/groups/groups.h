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
// Blocks of particles within a group are idle: a step leaves them out. Those that its neighbors
// read are placed before each step, all others when somebody asks for them. Those that particles of
// others may touch are watched, and wake in steps in which they are touched.
//
//     groups.watch(lists.arrays(), lists.take_changed(), ...);
//     groups.place(state, units);                // before a step
//     groups.wake(state);
//     step.grouped = groups.arrays();
//     groups.sum(bonds, step, units, by);
//     groups.bound(units, by, meets, parts, totals);
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

#include <sinew/body/body.h>
#include <sinew/body/forces.h>
#include <sinew/core/simulation_state.h>
#include <sinew/groups/affine/affine_forces.h>
#include <sinew/groups/cubic/inner_forces.h>
#include <sinew/groups/cubic/polynomials.h>
#include <sinew/groups/cubic/pulled_sample.h>
#include <sinew/groups/make_grouping.h>
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
  Groups() = default;
  Groups(std::shared_ptr<const Body> body, double mass, const kernel::Functions<Real>& kernel);

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
  /// Of each piece, the logarithm of by how much distances from particles of its groups to others
  /// of theirs may have changed since the beginning, summed up.
  const std::vector<double>& strains() const { return strains_; }
  /// By piece: whether a step computes some of it.
  const std::vector<std::uint8_t>& working_pieces() const { return working_; }
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
  void sum(const BondLists<Real>& bonds, const kernel::Step<Real>& step, const Units& units,
           const GroupStep& by);
  const GroupSums& sums() const { return sums_; }
  /// Raises the speeds in the totals of pieces to those of grouped particles in the step.
  /// `meets`: of a piece, whether particles of others are near.
  void bound(const Units& units, const GroupStep& by, const std::function<bool(std::size_t)>& meets,
             const kernel::Parts<Real>& parts, std::span<kernel::Totals> totals);
  void advance();
  /// Adds, to the cell of each particle on which forces were gathered in the last step, what of its
  /// acceleration the group does not follow. `cell`: by id.
  void add_held(std::span<const std::int32_t> cell, const Units& units,
                std::span<HeldCell> held) const;
  /// Throws Error (unstable) where a group is squeezed so much that more particles than the layers
  /// take for neighbors would exert forces on each other, or stretched so much that fewer would.
  void check_stretch();

  /// Fills what keeps the groups together, from all other forces and gravity (m/s^2). `caller`: of
  /// each place, that in `forces`.
  void constrain(Forces& forces, const std::vector<std::uint32_t>& caller,
                 const Vec3& gravity) const;

  void save(SimulationState& state) const;
  void restore(const SimulationState& state);

 private:
  static constexpr std::size_t block = BlockState<Real>::block;

  using Inverse = Eigen::Matrix<double, cubic_terms, cubic_terms>;

  /// Constant.
  struct Shape {
    Vec3 center = Vec3::Zero();  ///< m
    double size = 0;             ///< particles
    Mat3 frame = Mat3::Zero();   ///< 1/m: a particle's place in the group is frame (X - center)
    Vec3 reach = Vec3::Zero();   ///< of places there, at most
    bool cubic = false;
    Inverse inverse = Inverse::Zero();  ///< of the sum of the products of terms
  };
  /// Sums over particles in idle blocks.
  struct Idle {
    Terms terms = Terms::Zero();
    AffineMoments skin;  ///< of affine groups
  };
  /// The largest sizes of second derivatives within a group.
  struct Curvature {
    Mat3 x = Mat3::Zero(), v = Mat3::Zero();
  };
  /// Of the motion at a place in a group: derivatives along the axes of its frame, a column each.
  struct LocalMotion {
    Vec3 x, v;
    Mat3 dx, dv;
  };

  /// Places [begin, end) in the kernel's order, all of one group; and the row of the first.
  struct Run {
    std::uint32_t begin, end;
    std::int32_t group;
    std::int64_t row = 0;
  };
  /// By group.
  using Sums = std::vector<Coefficients>;
  /// Around the places in the group of its particles in a part of a piece.
  struct PieceBox {
    std::uint32_t piece, part;
    std::int32_t group;
    std::uint32_t begin, end;  ///< places among which they are
    Box box;
    Vec3 around = Vec3::Zero();  ///< half of the size of a box with all neighbors of these
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
  void find_frames();
  void find_inverses();
  void find_roles();
  void find_skins(std::int32_t rows);
  void find_pieces(std::size_t pieces);
  void find_boxes();
  void find_sample();
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
  void add_pulls(const kernel::PullSums& pulls, std::size_t group, Sums& all, Sums& damping);
  void add_awake(const BondLists<Real>& bonds, const kernel::Step<Real>& step, Sums& all,
                 Sums& damping, std::vector<Idle>& idle, std::vector<GroupForces>& inner);
  void add_skins(const std::vector<Idle>& idle, std::vector<GroupForces>& inner) const;
  void find_steady();
  GroupMotion in_kernel(std::size_t group, const Units& units) const;
  void put(const Run& run, BlockState<Real>& state, const Units& units) const;
  Coefficients sum_of(const Run& run) const;
  void add_bones(const kernel::Step<Real>& step, const Units& units, Sums& all, Sums& damping);
  void move(std::size_t group, const Coefficients& acceleration, const GroupStep& by);
  Curvature curvature_of(const Shape& shape, const GroupMotion& motion) const;
  LocalMotion motion_at(const Shape& shape, const GroupMotion& motion, const Vec3& at) const;
  double fastest_in(const PieceBox& one, const Units& units, const LocalMotion& local,
                    const Curvature& curvature, const kernel::RigidMotion<Real>& field) const;
  double fastest_of(const PieceBox& one, const Units& units, const GroupMotion& motion,
                    const kernel::RigidMotion<Real>& field) const;
  double strain_rate(const PieceBox& one, const LocalMotion& local,
                     const Curvature& curvature) const;
  void find_far_sites();
  double spare_in(const PieceBox& one) const;
  double spare_of(const Mat3& F) const;
  double spare_of_cubic(const Mat3& F, double changes) const;
  InnerParticles inner_particles() const;
  Vec3 place(std::size_t k) const { return {at_[0][k], at_[1][k], at_[2][k]}; }
  kernel::Motions motions_of(std::size_t group) const {
    return shapes_[group].cubic ? kernel::cubic : kernel::affine;
  }

  std::shared_ptr<const Body> body_;
  double mass_ = 0;
  kernel::Functions<Real> kernel_{};
  StretchRange stretch_{};
  std::optional<AffineForces> affine_;
  Points far_sites_;  ///< m: of particles that may not touch in cubic groups
  std::vector<Shape> shapes_;
  std::vector<Idle> idle_sums_;  ///< by group
  std::optional<InnerForces<Real>> inner_;
  std::vector<GroupMotion> motions_, next_;
  Sums accelerations_;                     ///< of the last step, m/s^2
  std::vector<double> strains_;            ///< by piece
  std::vector<double> strained_until_;     ///< by piece: when its stretches must be looked at
  std::vector<std::uint8_t> working_;      ///< by piece
  std::vector<std::int32_t> group_;        ///< by place in the kernel's order; -1: free
  std::array<std::vector<double>, 3> at_;  ///< by place, in the frame of its group
  std::array<std::vector<Real>, 3> at_of_kernel_;  ///< the same, padded
  std::vector<std::int32_t> id_;                   ///< by place
  std::vector<std::int32_t> role_;                 ///< by block: kernel::Role, or a row
  std::vector<std::uint8_t> asleep_;               ///< by block
  std::vector<std::uint8_t> whole_;                ///< by block
  std::vector<std::int32_t> of_piece_;             ///< by piece: its group, or -1
  std::vector<std::uint32_t> box_of_;              ///< by piece: of a group, its place in boxes_
  std::vector<Run> rim_;                           ///< of the blocks with rows
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
  std::vector<double> rates_;  ///< by box, of strain, 1/s
  int steps_ = 0;              ///< since they were found everywhere
  std::array<std::vector<Real>, 3> acceleration_;
  PulledSample<Real> sample_;
  GroupSums sums_;
};

}  // namespace sinew
