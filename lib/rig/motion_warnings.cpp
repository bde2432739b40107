// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/motion_warnings.h"

#include <cmath>
#include <functional>

#include "core/number_text.h"
#include "rig/joint_limits.h"
#include "rig/rotation_vector.h"

namespace sinew {
namespace {

constexpr double least_turn = pi / 180;

/// How far a bone's motion is from another of the same bone.
struct Gap {
  double turn = 0;   ///< rad
  double shift = 0;  ///< m, of head or tail
};

Gap gap_between(const Bone& bone, const LocalMotion& one, const LocalMotion& other) {
  return {rotation_vector(one.rotation * other.rotation.conjugate()).norm() +
              std::abs(one.twist - other.twist),
          (one.translation - other.translation).norm() +
              bone.length * std::abs(one.stretch - other.stretch)};
}

/// The bones whose gap is worth a word, told by the one that turns furthest.
struct Worst {
  std::size_t count = 0;
  std::string name;
  Gap gap;

  std::string text() const {
    std::string words = "bone '" + name + "'";
    if (count > 1) words += " (and " + std::to_string(count - 1) + " more)";
    return words;
  }
  std::string size() const {
    std::string words = three_digits(degrees(gap.turn)) + " degrees";
    if (gap.shift > 0) words += " and " + three_digits(gap.shift) + " m";
    return words;
  }
};

Worst worst_of(const Skeleton& skeleton, const Motion& motion, double least_shift,
               const std::function<Gap(const Bone&, const Track&)>& gap_of) {
  Worst worst;
  for (const Track& track : motion.tracks) {
    const Bone& bone = skeleton.bones[static_cast<std::size_t>(track.bone)];
    const Gap gap = gap_of(bone, track);
    if (gap.turn <= least_turn && gap.shift <= least_shift) continue;
    const bool first = worst.count++ == 0;
    if (first || gap.turn > worst.gap.turn) worst.name = bone.name, worst.gap = gap;
  }
  return worst;
}

using Warnings = std::vector<std::string>;

void warn_of_start(const Skeleton& skeleton, const Motion& motion, double least_shift,
                   Warnings& warnings) {
  if (motion.preroll > 0) return;
  const Worst worst =
      worst_of(skeleton, motion, least_shift, [&](const Bone& bone, const Track& track) {
        return gap_between(bone, track.at(motion.start), {});
      });
  if (worst.count > 0)
    warnings.push_back(worst.text() + " does not begin at rest but " + worst.size() +
                       " from it: the body is torn at the first step; set motion.preroll to 1, or "
                       "begin its keys with one that has no rotation and no translation");
}

void warn_of_loop(const Skeleton& skeleton, const Motion& motion, double least_shift,
                  Warnings& warnings) {
  if (motion.extrapolation != Extrapolation::loop) return;
  const double end = motion.start + clip_length(motion);
  const Worst worst =
      worst_of(skeleton, motion, least_shift, [&](const Bone& bone, const Track& track) {
        return gap_between(bone, track.at(motion.start), track.at(end));
      });
  if (worst.count > 0)
    warnings.push_back(worst.text() + " ends the clip " + worst.size() +
                       " from where it begins it: it jumps each time the loop begins again; use "
                       "motion.extrapolation ping_pong, or end with the first key");
}

template <class Curve>
bool steps(const Curve& curve) {
  return curve.interpolation == Interpolation::step && curve.times.size() > 1;
}

void warn_of_steps(const Skeleton& skeleton, const Motion& motion, Warnings& warnings) {
  for (const Track& track : motion.tracks)
    if (steps(track.rotation) || steps(track.twist) || steps(track.translation) ||
        steps(track.stretch))
      warnings.push_back("bone '" + skeleton.bones[static_cast<std::size_t>(track.bone)].name +
                         "' jumps from key to key: the body is torn at each; use interpolation "
                         "linear, smooth or cubic");
}

void warn_of_limits(const Skeleton& skeleton, const Motion& motion, Warnings& warnings) {
  for (const LimitPassed& passed : limits_passed(skeleton, motion)) {
    std::string text = "bone '" + skeleton.bones[static_cast<std::size_t>(passed.bone)].name +
                       "' is held at its limits, first at " + three_digits(passed.time) + " s:";
    if (passed.most.swing > 0)
      text += " swing by " + three_digits(degrees(passed.most.swing)) + " degrees beyond";
    if (passed.most.swing > 0 && passed.most.twist > 0) text += ',';
    if (passed.most.twist > 0)
      text += " twist by " + three_digits(degrees(passed.most.twist)) + " degrees beyond";
    warnings.push_back(text + "; widen its limits, or turn it less");
  }
}

}  // namespace

std::vector<std::string> motion_warnings(const Skeleton& skeleton, const Motion& motion,
                                         double least_shift) {
  Warnings warnings;
  warn_of_start(skeleton, motion, least_shift, warnings);
  warn_of_loop(skeleton, motion, least_shift, warnings);
  warn_of_steps(skeleton, motion, warnings);
  warn_of_limits(skeleton, motion, warnings);
  return warnings;
}

}  // namespace sinew
