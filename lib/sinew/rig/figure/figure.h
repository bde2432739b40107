// SPDX-License-Identifier: GPL-3.0-or-later
// A body for a rig alone: capsules along its bones, and of a figure a trunk as wide as its hips and
// shoulders, and a head.
//
//     const Anatomy anatomy = anatomy_of(skeleton);
//     for (const FigurePart& part : figure_of(skeleton, anatomy)) use(part.from, part.to);
#pragma once

#include <optional>
#include <vector>

#include <sinew/rig/figure/anatomy.h>

namespace sinew {

/// The points within `radius` of a line.
struct FigurePart {
  enum class Kind { limb, end, trunk, head };  ///< end: hands and feet

  int bone = no_bone;
  int hand = no_bone;  ///< the first bone of its hand or foot
  Kind kind = Kind::limb;
  Vec3 from, to;
  double radius = 0;
};

/// Parts as thick as a human has them, whatever is near. z is up; lengths are the skeleton's.
std::vector<FigurePart> parts_of(const Skeleton& skeleton, const Anatomy& anatomy);

/// Parts that are no neighbors stay apart by a fifth of the distance of their lines.
std::vector<FigurePart> figure_of(const Skeleton& skeleton, const Anatomy& anatomy);

/// Which parts are neighbors: those of one bone, of parent and child, of one hand or foot and the
/// bone that holds it, of the trunk with the head and with the inner halves of the limbs' first
/// bones, and those one after the other on a line of bones shorter than they are thick.
class Neighborhood {
 public:
  Neighborhood(const Skeleton& skeleton, const Anatomy& anatomy);
  /// The distance of their lines; of bones of one parent, and of the first bone of a limb from the
  /// body, that of the outer halves. Infinite for neighbors.
  double distance(const FigurePart& a, const FigurePart& b) const;

 private:
  bool joins(const FigurePart& a, const FigurePart& b) const;
  /// Whether one comes after the other, with less between them than they are thick.
  bool in_line(const FigurePart& a, const FigurePart& b) const;

  const Skeleton& skeleton_;
  std::vector<double> links_;
  std::vector<bool> begins_;  ///< true where a bone is the first of a limb outside of the trunk
};

/// The distance of two lines, from end to end.
double distance_between(const FigurePart& a, const FigurePart& b);

// In which pose a figure is made.

/// How well a pose shows the figure, 0 to 1: the fraction of their thickness that its limbs have
/// room for, times how straight they are, times how high the head is above the feet.
double openness(const Skeleton& posed, const Anatomy& anatomy, const Vec3& up);

/// The time of the pose, s of the clip, in which a figure is to be made; none: the file's own rest
/// pose. That one is left where another is over 1.4 times as open, or where a bone that only
/// carries the figure lies in it; of a rig that is no figure where the clip never brings some joint
/// within 120 degrees of its rest. Of the poses, those open to a twentieth less than the best
/// count, and of these the first.
std::optional<double> best_pose(const Rig& rig, const Anatomy& anatomy, const Vec3& up);

}  // namespace sinew
