// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of neighboring particles that move as one: the place of each is an affine function of its
// place X at rest, x = c + F X, or in large groups of bonded bodies a cubic one (groups.h).
//
// A particle of FCC with all its neighbors in its group is a center of inversion: whatever F is,
// pair forces, those of volumes and eq. 2 add up to zero on it. Where some are missing, at the
// surface of the body, they follow from F alone (affine_forces.h). Only the rim of a group, next to
// other particles, needs more, and what it feels moves the group by virtual work (groups.h).
//
//     body.grouping = std::make_shared<const Grouping>(make_grouping(body, group_of_particle));
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <sinew/body/grouping.h>
#include <sinew/core/rest_neighbors.h>

namespace sinew {

struct Body;

/// Whether this sinew has groups (SINEW_GROUPS). Without, all that makes some throws bad input.
bool groups_are_built();

inline constexpr std::size_t none_cubic = std::numeric_limits<std::size_t>::max();

/// Finds the layers of `group` (by particle id; below 0: free), and numbers the groups anew in the
/// order of their first particles. What is too thin to have an affine motion of its own becomes
/// free. Groups of `cubic_from` particles and more are cubic, unless they are sheets. `near`: the
/// neighbors at rest; none: the body's, or searched. In parallel.
Grouping make_grouping(const Body& body, std::vector<std::int32_t> group,
                       std::size_t cubic_from = none_cubic, SharedNeighbors near = {});

/// Frees groups that are sheets of a few layers, whose places do not tell cubics apart.
void free_sheets(const Body& body, std::vector<std::int32_t>& group);

/// How large groups are, and how near to joints that move.
struct GroupSizes {
  /// Particles nearer than this to a joint are free: along the bone, in square roots of the
  /// cross-section of the bone whose head the joint is.
  double joint_distance = 1;
  std::size_t min_particles = 4096;  ///< particles of a group
  /// The same for cubic groups; none: there are none.
  std::optional<double> cubic_distance = {};
  std::size_t min_cubic = 16384;  ///< particles of a cubic group
  /// Marks by particle id: 1 stays free (kept_free.h); empty: none.
  std::vector<std::uint8_t> kept_free = {};

  std::size_t cubic_from() const { return cubic_distance ? min_cubic : none_cubic; }
};

/// Groups that change as the body moves.
struct DynamicOptions {
  GroupSizes sizes;
  /// In radii. What joins a group is moved by less (root mean square, half as much where it was
  /// free); what leaves it would be, by the forces that hold it there.
  double tolerance = 0.15;
  SharedNeighbors near = {};  ///< neighbors of the body, which may have released its own
};

/// The stretches of a group between which forces act between those particles alone that the layers
/// take for neighbors, and between all of them. Cubic groups know second neighbors that touch.
struct StretchRange {
  double min, min_cubic, max;
};
StretchRange stretch_range(const Body& body);

/// Whether groups of the body may move by cubics: what acts within them are bonds alone.
bool supports_cubic_groups(const Body& body);

/// Throws bad input for features of the body that exclude groups (core/capabilities.h).
void check_groupable(const Body& body);
/// The same for groups that change: where obstacles press is known of what bones carry alone.
void check_groupable_as_it_moves(const Body& body);

}  // namespace sinew
