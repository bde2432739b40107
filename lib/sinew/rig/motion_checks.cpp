// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/motion_checks.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <sinew/core/text.h>
#include <sinew/core/vector.h>

namespace sinew {

namespace {

/// A rotation as a twist about `axis`, then a swing by `lean` about `about` (across the axis).
struct SwingTwist {
  Vec3 axis, about;
  double lean = 0, twist = 0;

  Quat twist_turn() const { return rotation_by(twist * axis); }
};

SwingTwist swing_twist_of(const Quat& rotation, const Vec3& axis) {
  const double along = rotation.vec().dot(axis), length = std::hypot(rotation.w(), along);
  SwingTwist swing_twist{axis, Vec3::Zero()};
  if (length > 0)
    swing_twist.twist = rotation_vector({rotation.w() / length, axis.x() * along / length,
                                         axis.y() * along / length, axis.z() * along / length})
                            .dot(axis);
  const Vec3 swing = rotation_vector(rotation * swing_twist.twist_turn().conjugate());
  swing_twist.lean = swing.norm();
  if (swing_twist.lean > 0) swing_twist.about = swing / swing_twist.lean;
  return swing_twist;
}

/// Rates of a swing and a twist, rad/s: lean, its direction (about the axis at rest), twist.
struct Rates {
  double lean, round, twist;
};

/// Solves omega = round (axis - direction) + lean about + twist direction.
Rates rates_of(const SwingTwist& swing_twist, const Vec3& omega) {
  const Vec3 direction = rotation_by(swing_twist.lean * swing_twist.about) * swing_twist.axis;
  const double sine = std::sin(swing_twist.lean);
  const double across = omega.cross(direction).dot(swing_twist.about);
  return {omega.dot(swing_twist.about), sine > 0 ? across / sine : 0,
          omega.dot(direction) + across * std::tan(swing_twist.lean / 2)};
}

void limit_swing(const Bone& bone, const SwingTwist& swing_twist, const Rates& rates,
                 LocalMotion& motion) {
  const Vec3& axis = bone.axis();
  const Quat swing = rotation_by(bone.limits.swing * swing_twist.about);
  const Vec3 direction = swing * axis;
  motion.rotation = swing * swing_twist.twist_turn();
  motion.angular_velocity = rates.round * (axis - direction) + rates.twist * direction;
}

}  // namespace

Excess limit(const Bone& bone, LocalMotion& motion) {
  const JointLimits& limits = bone.limits;
  if (!limits.any()) return {};
  const SwingTwist swing_twist = swing_twist_of(motion.rotation, bone.axis());
  const Rates rates = rates_of(swing_twist, motion.angular_velocity);
  const double twist = swing_twist.twist + motion.twist;
  const double allowed = std::clamp(twist, limits.min_twist, limits.max_twist);
  const Excess excess = {std::max(0.0, swing_twist.lean - limits.swing), std::abs(twist - allowed)};
  if (excess.swing > 0) limit_swing(bone, swing_twist, rates, motion);
  if (excess.twist > 0) {
    motion.twist += allowed - twist;
    motion.twist_rate = -rates.twist;  // compensates the rotation about the bone
  }
  return excess;
}

namespace {

/// Moments of the clip, from its start, at which a track is sampled: its keys and three more
/// between each two.
std::vector<double> moments_of(const Track& track, const Motion& motion) {
  const double length = clip_length(motion);
  std::vector<double> keys = {0, length};
  for (const auto* times : {&track.rotation.times, &track.twist.times})
    for (const double time : *times)
      if (time > motion.start && time < motion.start + length) keys.push_back(time - motion.start);
  std::sort(keys.begin(), keys.end());
  std::vector<double> moments;
  for (std::size_t i = 0; i + 1 < keys.size(); ++i)
    for (int part = 0; part < 4; ++part)
      moments.push_back(keys[i] + (keys[i + 1] - keys[i]) * part / 4);
  moments.push_back(length);
  return moments;
}

}  // namespace

double first_key(const Motion& motion) {
  double first = std::numeric_limits<double>::infinity();
  for (const Track& track : motion.tracks) {
    const auto visit = [&](const auto& curve) {
      if (curve.times.size() > 1) first = std::min(first, curve.times.front());
    };
    visit(track.rotation), visit(track.translation), visit(track.twist), visit(track.stretch);
  }
  return std::isfinite(first) ? first : 0;
}

std::optional<IgnoredScale> largest_scale(const Motion& motion, const std::vector<bool>& bones) {
  std::optional<IgnoredScale> largest;
  const auto size = [](const IgnoredScale& one) { return std::abs(std::log(one.factor)); };
  for (const IgnoredScale& one : motion.ignored_scales)
    if (bones[static_cast<std::size_t>(one.bone)] && (!largest || size(one) > size(*largest)))
      largest = one;
  return largest;
}

namespace {

double distance(double a, double b) { return std::abs(a - b); }
double distance(const Quat& a, const Quat& b) { return a.angularDistance(b); }
double distance(const Vec3& a, const Vec3& b) { return (a - b).norm(); }

/// Whether a curve departs from its first value by over a threshold.
template <class Curve>
bool changes(const Curve& curve, double threshold) {
  return std::any_of(curve.values.begin(), curve.values.end(), [&](const auto& value) {
    return distance(curve.values.front(), value) > threshold;
  });
}

}  // namespace

MovingBones moving_bones(const Skeleton& skeleton, const Motion& motion) {
  constexpr double min_turn = pi / 180, min_travel = 1e-3;
  const double travel = min_travel * bounds(skeleton).diagonal().norm();
  MovingBones moving;
  for (const Track& track : motion.tracks) {
    const bool turns = changes(track.rotation, min_turn) || changes(track.twist, min_turn);
    if (turns) moving.turned.push_back(track.bone);
    if (turns || changes(track.translation, travel)) moving.all.push_back(track.bone);
  }
  std::sort(moving.turned.begin(), moving.turned.end());
  std::sort(moving.all.begin(), moving.all.end());
  return moving;
}

std::vector<LimitPassed> limits_passed(const Skeleton& skeleton, const Motion& motion) {
  std::vector<LimitPassed> all;
  for (const Track& track : motion.tracks) {
    const Bone& bone = skeleton.bones[static_cast<std::size_t>(track.bone)];
    if (!bone.limits.any()) continue;
    LimitPassed passed;
    for (const double time : moments_of(track, motion)) {
      LocalMotion requested = track.at(motion.start + time);
      const Excess excess = limit(bone, requested);
      if (excess.any() && !passed.most.any()) {
        passed.bone = track.bone;
        passed.time = motion.preroll + time / motion.speed;
      }
      passed.most.swing = std::max(passed.most.swing, excess.swing);
      passed.most.twist = std::max(passed.most.twist, excess.twist);
    }
    if (passed.most.any()) all.push_back(passed);
  }
  return all;
}

namespace {

// Smaller gaps are neither warned of nor need a preroll; the shift over the skeleton's size.
constexpr double min_turn = pi / 180, min_shift_of_size = 1e-3;

/// The difference between two motions of a bone.
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

/// Bones whose gap exceeds the threshold, represented by the one that rotates most.
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

Worst worst_of(const Skeleton& skeleton, const Motion& motion, double min_shift,
               const std::function<Gap(const Bone&, const Track&)>& gap_of) {
  Worst worst;
  for (const Track& track : motion.tracks) {
    const Bone& bone = skeleton.bones[static_cast<std::size_t>(track.bone)];
    const Gap gap = gap_of(bone, track);
    if (gap.turn <= min_turn && gap.shift <= min_shift) continue;
    const bool first = worst.count++ == 0;
    if (first || gap.turn > worst.gap.turn) worst.name = bone.name, worst.gap = gap;
  }
  return worst;
}

}  // namespace

double preroll_for(const Skeleton& skeleton, const Motion& motion) {
  constexpr double turn_per_second = pi / 2, sizes_per_second = 0.5;
  const double size = bounds(skeleton).diagonal().norm();
  double most = 0, shift = 0;
  for (const Track& track : motion.tracks) {
    const Bone& bone = skeleton.bones[static_cast<std::size_t>(track.bone)];
    most = std::max(most, gap_between(bone, track.at(motion.start), {}).turn);
  }
  Motion clip = motion;
  clip.preroll = 0;
  const Pose first = pose_at(skeleton, clip, 0), rest = rest_pose(skeleton);
  for (std::size_t b = 0; b < first.size(); ++b)
    shift = std::max(shift, (first[b].frame.origin - rest[b].frame.origin).norm());
  if (most <= min_turn && shift <= min_shift_of_size * size) return 0;
  const double time = std::max(most / turn_per_second, shift / (sizes_per_second * size));
  return std::ceil(10 * time - 1e-9) / 10;
}

namespace {

using Warnings = std::vector<std::string>;

void warn_of_start(const Skeleton& skeleton, const Motion& motion, double min_shift,
                   Warnings& warnings) {
  if (motion.preroll > 0) return;
  const Worst worst =
      worst_of(skeleton, motion, min_shift, [&](const Bone& bone, const Track& track) {
        return gap_between(bone, track.at(motion.start), {});
      });
  if (worst.count > 0)
    warnings.push_back(worst.text() + " does not begin at rest but " + worst.size() +
                       " from it: the body tears at the first step; set motion.preroll to 1, or "
                       "begin its keys with one that has no rotation and no translation");
}

void warn_of_loop(const Skeleton& skeleton, const Motion& motion, double min_shift,
                  Warnings& warnings) {
  if (motion.extrapolation != Extrapolation::loop) return;
  const double end = motion.start + clip_length(motion);
  const Worst worst =
      worst_of(skeleton, motion, min_shift, [&](const Bone& bone, const Track& track) {
        return gap_between(bone, track.at(motion.start), track.at(end));
      });
  if (worst.count > 0)
    warnings.push_back(worst.text() + " ends the clip " + worst.size() +
                       " from where it begins it: it jumps each time the loop begins again; use "
                       "motion.extrapolation ping_pong, or end with the first key");
}

template <class Curve>
bool jumps(const Curve& curve, double threshold) {
  const auto far = [&](const auto& a, const auto& b) { return distance(a, b) > threshold; };
  return curve.interpolation == Interpolation::step &&
         std::adjacent_find(curve.values.begin(), curve.values.end(), far) != curve.values.end();
}

void warn_of_steps(const Skeleton& skeleton, const Motion& motion, double min_shift,
                   Warnings& warnings) {
  Worst jumping;
  for (const Track& track : motion.tracks) {
    const Bone& bone = skeleton.bones[static_cast<std::size_t>(track.bone)];
    if (!jumps(track.rotation, min_turn) && !jumps(track.twist, min_turn) &&
        !jumps(track.translation, min_shift) && !jumps(track.stretch, min_shift / bone.length))
      continue;
    if (jumping.count++ == 0) jumping.name = bone.name;
  }
  if (jumping.count > 0)
    warnings.push_back(jumping.text() +
                       " jumps from key to key: the body tears at each; use interpolation "
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
                                         double min_shift, bool posed) {
  Warnings warnings;
  if (!posed) warn_of_start(skeleton, motion, min_shift, warnings);
  warn_of_loop(skeleton, motion, min_shift, warnings);
  warn_of_steps(skeleton, motion, min_shift, warnings);
  warn_of_limits(skeleton, motion, warnings);
  return warnings;
}

std::string scale_warning(const Skeleton& skeleton, const Motion& motion,
                          const std::vector<bool>& bones) {
  const std::optional<IgnoredScale> largest = largest_scale(motion, bones);
  if (!largest) return "";
  return "the clip scales bone '" + skeleton.bones[static_cast<std::size_t>(largest->bone)].name +
         "' to " + three_digits(largest->factor) +
         " of its size: bones keep theirs, and the body is not as the file shows it; choose "
         "another clip (motion.clip), or export it without scale";
}

}  // namespace sinew
