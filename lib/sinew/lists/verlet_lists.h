// SPDX-License-Identifier: GPL-3.0-or-later
// The neighbor lists of a moving body: at every step the inner lists hold all pairs within range.
//
// The outer lists of a piece, found among the pieces near it, are valid for long; its inner lists,
// pruned from them, are what the kernel traverses. Both are valid until particles of the piece and
// of its neighbors have approached by their skins (see near_pieces.h), and are then made again for
// that piece alone.
//
// Lists of materials that know their neighbors at rest hold contacts: pairs that are not bonded,
// within 2r. In a packed body they are empty until its surface folds onto itself.
//
//     lists.make(state, subpieces, bonds, units);     // at first, and in a new order
//     step.lists = lists.arrays(), step.subpieces = lists.subpieces();
//     lists.follow(state, bonds, units, totals);  // after every step
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <sinew/kernel/kernel.h>
#include <sinew/lists/block_state.h>
#include <sinew/lists/list_counts.h>
#include <sinew/lists/near_pieces.h>
#include <sinew/lists/offset_lists.h>
#include <sinew/lists/passing_pairs.h>
#include <sinew/lists/subpieces.h>
#include <sinew/material/material.h>

namespace sinew {

template <class Real>
class VerletLists {
 public:
  VerletLists() = default;
  /// For steps of `step` (s).
  VerletLists(const kernel::Functions<Real>& kernel, const Material& material, double step);

  /// Leaves out pairs of particles that pass through each other, from the next lists on; `id` in
  /// the kernel's order. The body must outlive the lists.
  void let_pass(const Body& body, std::span<const std::int32_t> id);

  /// The inner lists, by piece.
  const kernel::Lists* arrays() const { return arrays_.data(); }
  /// Subpieces of the pieces, their velocity fields, and where a step tells how far these are off.
  kernel::Subpieces<Real> subpieces();
  /// Counts what moved a piece's particle by so much (lengths of the kernel) with the step before.
  void add_moved(std::size_t piece, double moved);

  /// Lists of the same kind, for steps of `step` (s), not yet made, that go on with its counts.
  VerletLists cleared(double step) const;
  bool made() const { return !inner_.empty(); }
  /// Makes all lists; or those of some of the pieces of a large body, to see how long they are.
  void make(BlockState<Real>& state, Subpieces subpieces, const BondLists<Real>& bonds,
            const Units& units, const GroupedParticles& groups = {});
  void make_some(BlockState<Real>& state, Subpieces subpieces, const BondLists<Real>& bonds,
                 const Units& units);
  /// Whether they are the lists of all pieces.
  bool whole() const { return whole_; }
  /// Makes those that are no longer valid after a step with these sums.
  void follow(BlockState<Real>& state, const BondLists<Real>& bonds, const Units& units,
              std::span<const kernel::Totals> totals, const GroupedParticles& groups = {});
  /// Whether a piece is near particles of others than its group.
  bool meets_others(std::size_t piece) const;
  /// Pieces whose inner lists were made since they were last asked for.
  std::vector<std::uint32_t> take_changed() { return std::exchange(changed_, {}); }

  /// Where bonds may flow: pieces that a bond broke near, whose particles have moved too far
  /// relative to each other since they were looked at, or that are near one that flows.
  std::vector<std::uint32_t> to_look_at(const std::function<bool(std::size_t)>& flows) const;
  void looked_at(std::size_t piece, double still);
  /// Returns the range of the outer lists, in lengths of the kernel.
  double outer_range() const { return ranges_.outer; }

  /// Around the particles of a piece, m.
  Box box_of(std::size_t piece, const Units& units) const;

  /// Differences per block in the outer lists, on average.
  double mean_of_outer() const { return mean(outer_); }
  ListCounts counts() const;

 private:
  static double mean(const std::vector<OffsetLists>& lists);
  void make_each(std::size_t nth, BlockState<Real>& state, Subpieces subpieces,
                 const BondLists<Real>& bonds, const Units& units, const GroupedParticles& groups);
  void survey(BlockState<Real>& state, const GroupedParticles& groups);
  PieceNow survey(std::size_t subpiece, BlockState<Real>& state);
  void move_fields();
  std::vector<double> fastest_of_subpieces() const;
  double lengthening(std::size_t subpiece) const;
  void place_field(std::size_t subpiece, const Vec3& at);
  template <class Visit>
  void for_each_subpiece(std::size_t piece, const Visit& visit) const {
    for (std::uint32_t subpiece = of_.of_piece[piece]; subpiece < of_.of_piece[piece + 1];
         ++subpiece)
      visit(subpiece);
  }
  std::vector<std::uint32_t> pieces_of(const std::vector<std::uint32_t>& subpieces) const;
  std::vector<std::uint32_t> pieces_near(std::size_t piece) const;
  void list(BlockState<Real>& state, const BondLists<Real>& bonds,
            const std::vector<std::uint32_t>& pieces, const GroupedParticles& groups);
  std::vector<std::int32_t> groups_of_subpieces(const GroupedParticles& groups) const;
  void show_around(const std::vector<std::uint32_t>& pieces, const GroupedParticles& groups) const;
  void add_strained(const GroupedParticles& groups, std::vector<std::uint32_t>& to_list,
                    std::vector<std::uint32_t>& to_prune) const;
  void prune(BlockState<Real>& state, std::size_t piece, const GroupedParticles& groups);
  void find_boxes_around(BlockState<Real>& state, const std::vector<std::uint32_t>& pieces);

  kernel::Functions<Real> kernel_{};
  bool contacts_ = false;  ///< not all pairs
  PassingPairs passing_;
  bool looks_ = false;  ///< bonds may flow
  ListRanges wanted_;   ///< m
  double step_ = 0;     ///< s
  double time_ = 0;     ///< length of a step, in times of the kernel
  ListRanges ranges_;   ///< in its lengths

  Subpieces of_;
  // Values by subpiece:
  NearPieces near_;
  std::vector<Real> fastest_;  ///< squared, in the last step
  std::vector<kernel::RigidMotion<Real>> motions_;
  std::vector<Vec3> centers_;  ///< centers of the subpieces at the survey
  std::vector<Mat3> axes_;     ///< axes of the particles, at the last survey
  std::vector<double> speed_;  ///< upper bound of the velocity field
  double elapsed_ = 0;         ///< since the survey, in times of the kernel
  // Values by piece:
  std::vector<OffsetLists> outer_, inner_;
  std::vector<kernel::Lists> arrays_;
  std::vector<std::uint8_t> grouped_;  ///< pieces of one group alone
  bool whole_ = false;
  BlockBoxes boxes_;
  std::vector<std::int64_t> boxed_;  ///< moment for which each piece's boxes are valid
  std::int64_t moment_ = 0;
  std::vector<std::uint32_t> changed_;
  std::vector<std::uint8_t> looked_;  ///< one per piece
  /// Strain of each piece of a group when its lists were made.
  std::vector<double> listed_at_, pruned_at_;

  ListCounts counts_;
};

}  // namespace sinew
