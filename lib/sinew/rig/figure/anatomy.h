// SPDX-License-Identifier: GPL-3.0-or-later
// What the joints of a rig are to a figure: two pairs of limbs on a trunk, and a head. Found by
// the lengths between joints alone, which no pose changes; names do not count.
//
//     const Anatomy anatomy = anatomy_of(skeleton);
//     if (anatomy.is_figure()) use(anatomy.legs().joint[0]);
#pragma once

#include <array>
#include <vector>

#include <sinew/rig/motion.h>
#include <sinew/rig/skeleton.h>

namespace sinew {

/// Two limbs of one length that leave the same bone.
struct LimbPair {
  int fork = no_bone;                             ///< the bone that they leave
  std::array<int, 2> first = {no_bone, no_bone};  ///< its children, such as collar bones
  std::array<int, 2> joint = {no_bone, no_bone};  ///< the first long bones, such as upper arms
  std::array<int, 2> tip = {no_bone, no_bone};    ///< the last bones on the longest way
  std::array<double, 2> length = {0, 0};          ///< path from `first` to the tail of `tip`
};

struct Anatomy {
  std::vector<LimbPair> pairs;  ///< legs, then arms, of a figure; empty otherwise
  std::vector<int> trunk;       ///< bones between them, from the fork of the legs
  std::vector<int> head;        ///< bones from the fork of the arms to the end of the head
  double height = 0;            ///< standing, in the skeleton's lengths
  double size = 0;              ///< the longest way between two ends along the bones

  bool is_figure() const { return !pairs.empty(); }
  const LimbPair& legs() const { return pairs.front(); }
  const LimbPair& arms() const { return pairs.back(); }
};

Anatomy anatomy_of(const Skeleton& skeleton);

/// The distance of each bone's head from its parent's, 0 for roots.
std::vector<double> links_of(const Skeleton& skeleton);

/// The child with the longest way to an end, of each bone; no_bone where there is none.
std::vector<int> longest_children(const Skeleton& skeleton);

// Where up is: a figure holds its trunk above its legs, and lets its arms hang.

/// The mean of what points up in the poses, of any length; 0 where it is no figure.
Vec3 up_in(const Anatomy& anatomy, const Skeleton& skeleton, const std::vector<Pose>& poses);

/// Poses at about `count` times of the clip, evenly, the first and the last among them.
std::vector<double> times_in(const Motion& motion, int count);

}  // namespace sinew
