// SPDX-License-Identifier: GPL-3.0-or-later
// How near the pieces of a body may have come to each other: whose lists are still valid.
//
// Particles i and j of the pieces p and q approach no faster than
//
//     |v_i - w_p(x_i)| + |v_j - w_q(x_j)| + |w_p(x) - w_q(x)|,
//
// where w is a piece's rigid velocity field, whatever it is, and x is either of the two places: the
// rotation that both fields share moves particles across the line between them. The kernel finds
// the largest of the first two terms in every step; the third is bounded in the region where the
// pieces can meet. What pairs of pieces have used up of the skins is added step by step, so the
// lists of a piece are made again when its own surroundings have changed, and not before.
//
// What are pieces here are subpieces of those of the kernel, where these are of several bones or
// groups (subpieces.h).
//
// Pieces that are bound to each other, because all of their particles are of one group
// (groups/groups.h), are left to the caller, and looked up only when it asks.
//
//     NearPieces near(ranges, group_of_pieces);
//     near.survey(pieces, time);    // now and then: how the pieces move
//     near.advance(fastest, time);  // after every step
//     for (const std::uint32_t piece : near.to_list()) ... near.listed(piece);
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/lists/piece_tree.h>

namespace sinew {

/// Distances that lists hold, and how often the motion of pieces is found.
struct ListRanges {
  double force = 0;  ///< within which particles interact
  double inner = 0;  ///< range of the inner lists when they were made
  double outer = 0;  ///< range of the outer lists
  int steps = 8;     ///< between surveys, at least, but where particles travel too far
};

class NearPieces {
 public:
  /// Another piece that may be within the outer range.
  struct Near {
    std::uint32_t piece;
    float rate;  ///< rate of approach by the difference of the velocity fields
    double gap;  ///< between the boxes at the survey
    /// How much nearer than at the survey particles may come that the lists do not pair.
    double outer, inner;
    /// How far particles of both may move relative to each other since the survey before the caller
    /// must look at them.
    double still;
  };

  NearPieces() = default;
  /// `bound_to`: by piece, those with the same number are bound to each other, but for -1; empty:
  /// none are.
  /// `looks`: the caller wants to look at pieces whose particles have moved relative to each other.
  explicit NearPieces(const ListRanges& ranges, std::span<const std::int32_t> bound_to = {},
                      bool looks = false)
      : ranges_(ranges), bound_to_(bound_to.begin(), bound_to.end()), looks_(looks) {}

  /// How the pieces move and where they are from now on, for steps of `time`.
  void survey(std::vector<PieceNow> pieces, double time);
  /// The mean velocity. Until the next survey, the velocity fields travel with it.
  const Vec3& common_velocity() const { return common_; }
  /// After a step of `time`, in which no particle was faster than `fastest` of its piece relative
  /// to the velocity field. False where particles have gone too far since the survey: all lists are
  /// to be made again.
  bool advance(std::span<const double> fastest, double time);
  /// Around the particles of a piece now, `elapsed` after the survey.
  Box box_of(std::size_t piece, double elapsed) const;
  /// Whether a survey must come before the next step, or would serve.
  bool survey_due() const;

  /// Pieces whose outer lists are no longer valid, and others whose inner lists are not.
  const std::vector<std::uint32_t>& to_list() const { return to_list_; }
  const std::vector<std::uint32_t>& to_prune() const { return to_prune_; }
  /// Pieces that the caller must look at.
  const std::vector<std::uint32_t>& to_look_at() const { return to_look_at_; }
  /// It has: until their particles have moved by so much relative to each other, and to those of
  /// pieces near it, it need not again.
  void looked_at(std::size_t piece, double still);
  /// The outer lists of the piece were made from its present neighbors.
  void listed(std::size_t piece);
  /// Its inner lists were made from its outer lists.
  void pruned(std::size_t piece);

  /// The pieces near one, itself included, ascending.
  std::vector<std::uint32_t> of(std::size_t piece) const;
  /// Returns those that are not bound to it.
  std::span<const Near> others(std::size_t piece) const { return near_[piece]; }

 private:
  static constexpr std::int32_t unbound = -1;

  /// How fast particles of a piece move as a rigid body, wherever they have traveled before the
  /// next survey.
  struct Field {
    Vec3 middle, velocity;  ///< middle of the box, and the velocity there
    double radius;          ///< around the particles, from there
    double speed;           ///< relative to the common velocity, at most
  };

  Field field_of(std::size_t piece) const;
  double find_fields();
  void find_limits(double time);
  void find_near(std::size_t piece);
  double fastest_approach(std::size_t piece, std::size_t other) const;
  double gap_within(std::size_t piece, std::size_t other) const;
  template <class Visit>
  void for_each_near(std::size_t piece, std::int32_t group, const Visit& visit) const;
  float rate_between(std::size_t piece, std::size_t near) const;
  void find_rates(std::size_t piece);
  void copy_rates(std::size_t piece);
  void rebase_margins(std::size_t piece);
  void find_spare(std::size_t piece);
  void collect_due_pieces();
  /// How much nearer particles of a piece and one near it may have come since the survey.
  double used_of(std::size_t piece, const Near& near) const {
    return gone_[piece] + gone_[near.piece] + static_cast<double>(near.rate) * elapsed_;
  }
  std::int32_t group_of(std::size_t piece) const {
    return bound_to_.empty() ? unbound : bound_to_[piece];
  }

  /// The least that was left of the skins between a piece and any near it when it was looked at.
  struct Spare {
    double outer = std::numeric_limits<double>::infinity(), inner = outer, still = outer;
    double rate = 0;  ///< the largest of those near it
    double used = 0;  ///< since then, at most
  };

  ListRanges ranges_;
  std::vector<std::int32_t> bound_to_;
  bool looks_ = false;
  std::vector<PieceNow> pieces_;
  PieceTree tree_;
  std::vector<Field> fields_;            ///< one per piece
  std::vector<std::vector<Near>> near_;  ///< pieces near each, ascending, but for those bound to it
  Vec3 common_ = Vec3::Zero();
  // Relative to the common velocity, of any piece as a rigid body:
  double fastest_point_ = 0;
  double travel_ = 0;    ///< before the next survey, at most
  double horizon_ = 0;   ///< until the next survey
  double traveled_ = 0;  ///< since the survey, at most
  // Drift of particles of each piece from its velocity field, at most:
  std::vector<double> drift_;  ///< before the next survey
  std::vector<double> gone_;   ///< since the survey
  std::vector<double> last_;   ///< in the last step
  double drifted_ = 0;         ///< drift of any piece, since the survey
  double elapsed_ = 0;         ///< since the survey
  int steps_ = 0;              ///< since the survey
  std::vector<Spare> spare_;
  std::vector<std::uint32_t> to_list_, to_prune_, to_look_at_;
};

/// Groups of particles, which are not always at their places (groups/groups.h).
struct GroupedParticles {
  /// Puts those of some pieces there.
  std::function<void(std::span<const std::uint32_t> pieces)> show = [](const auto&) {};
  std::span<const std::int32_t> of_piece = {};  ///< a piece's only group, or -1; empty: all are -1
  /// How a piece of one group moves.
  std::function<PieceNow(std::size_t piece)> piece_now = {};
  /// Logarithm of by how much distances in each piece's group may have changed, summed up.
  std::span<const double> strain = {};
  std::span<const std::uint8_t> working = {};  ///< one per piece: a step needs its lists
};

}  // namespace sinew
