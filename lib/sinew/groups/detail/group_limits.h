// SPDX-License-Identifier: GPL-3.0-or-later
// How fast and how much groups move and strain anywhere, at most: from the middles of boxes around
// their particles, and from bounds of second derivatives. What neighbor lists need to know of
// groups follows, and when forces act within them that they do not know of.
//
//     limits.bound(units, by, meets, subpieces, totals);  // after a step
//     limits.check_stretch();
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <sinew/groups/detail/group_layout.h>
#include <sinew/groups/detail/group_motions.h>
#include <sinew/groups/detail/group_shapes.h>
#include <sinew/groups/groups.h>
#include <sinew/groups/make_grouping.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/near_pieces.h>

namespace sinew {

template <class Real>
class GroupLimits {
 public:
  GroupLimits() = default;
  /// All but the kernel's functions outlive it.
  GroupLimits(const Body& body, const kernel::Functions<Real>& kernel,
              const std::vector<GroupShape>& shapes, const GroupLayout<Real>& layout,
              const GroupMotions<Real>& motions);

  /// Follows a new order of the layout's particles.
  void set_order();
  /// Looks at all stretches at the next check: groups have moved otherwise than by steps.
  void look_again();
  /// Raises the speeds in the totals of pieces to those of grouped particles in the step.
  /// `meets`: of a piece, whether particles of others are near.
  void bound(const Units& units, const GroupStep& by, const std::function<bool(std::size_t)>& meets,
             const kernel::Subpieces<Real>& subpieces, std::span<kernel::Totals> totals);
  /// Throws Error (unstable) where a group is squeezed so much that more particles than the layers
  /// take for neighbors would exert forces on each other, or stretched so much that fewer would.
  void check_stretch();

  /// How a piece of one group moves, in the kernel's units.
  PieceNow piece_now(std::size_t piece, const Units& units) const;
  /// Returns by piece the logarithm of by how much distances from particles of its groups to others
  /// of theirs may have changed since the beginning, summed up.
  const std::vector<double>& strains() const { return strains_; }

 private:
  /// Box around the places in the group of its particles in a subpiece.
  struct PieceBox {
    std::uint32_t piece, subpiece;
    std::int32_t group;
    std::uint32_t begin, end;  ///< places among which they are
    Box box;
    Vec3 around = Vec3::Zero();  ///< half of the size of a box with all neighbors of these
  };

  void find_far_sites();
  double fastest_of(const PieceBox& one, const Units& units, const GroupMotion& motion,
                    const kernel::RigidMotion<Real>& field) const;
  double spare_in(const PieceBox& one) const;
  double spare_of(const Mat3& F) const;
  double spare_of_cubic(const Mat3& F, double changes) const;
  const GroupShape& shape_of(const PieceBox& one) const {
    return (*shapes_)[static_cast<std::size_t>(one.group)];
  }
  const GroupMotion& motion_of(const PieceBox& one) const {
    return motions_->now()[static_cast<std::size_t>(one.group)];
  }

  const Body* body_ = nullptr;
  kernel::Functions<Real> kernel_{};
  const std::vector<GroupShape>* shapes_ = nullptr;
  const GroupLayout<Real>* layout_ = nullptr;
  const GroupMotions<Real>* motions_ = nullptr;
  StretchRange stretch_{};
  Points far_sites_;  ///< m: of particles that may not touch in cubic groups
  std::vector<PieceBox> boxes_;
  std::vector<std::uint32_t> box_of_;   ///< one per piece: place in boxes_ of pieces of a group
  std::vector<double> strains_;         ///< one per piece
  std::vector<double> strained_until_;  ///< one per piece: when its stretches must be looked at
  std::vector<double> rates_;           ///< rate of strain of each box, 1/s
  int steps_ = 0;                       ///< since they were found everywhere
};

}  // namespace sinew
