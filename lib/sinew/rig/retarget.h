// SPDX-License-Identifier: GPL-3.0-or-later
// A clip of one skeleton for the bones of another: names that differ by prefix, side, case or habit
// (Mixamo, CMU, VRM, Unreal, Daz), rest poses that differ (arms down or out), sizes.
//
//     const auto names = matched_names(body.skeleton, walk.skeleton);
//     const Retargeted own = retargeted(walk.skeleton, walk.clips[0], body.skeleton, names);
#pragma once

#include <string>
#include <vector>

#include <sinew/core/options.h>
#include <sinew/rig/motion.h>

namespace sinew {

/// Which bone of `from` moves which bone of `to`, as [name in `to`, name in `from`], each once, in
/// the order of `to`: equal names first; then the same side and word, without prefixes
/// ("mixamorig:", "Armature_", "J_Bip_"), case and separators; then words for one part of a body
/// ("thigh", "UpLeg").
std::vector<NamePair> matched_names(const Skeleton& to, const Skeleton& from);

/// Whether all pairs have one name twice.
bool are_same(const std::vector<NamePair>& names);

struct Retargeted {
  Motion motion;
  std::vector<std::string> warnings;  ///< joints without a bone, bones without a joint, other rests
};

/// The clip's motion for the bones of `to`: each has the direction in space of the bone that moves
/// it, whatever their rest poses: the way from its head to the head of the next bone of `names`, or
/// of bones with several or no next ones, the turn of the bone above from rest. The topmost ones
/// also move, by the ratio of the skeletons' sizes, from where they rest; those that begin far from
/// their rest, as of clips that rest at the origin, from where they begin. Sampled at the clip's
/// keys, at 30 a second or more. Throws bad_value with the key "names" for a name that is in
/// neither skeleton, or twice.
Retargeted retargeted(const Skeleton& from, const Clip& clip, const Skeleton& to,
                      const std::vector<NamePair>& names);

}  // namespace sinew
