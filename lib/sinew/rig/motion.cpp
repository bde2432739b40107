// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/motion.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/core/vector.h>
#include <sinew/rig/motion_checks.h>

namespace sinew {

namespace {

constexpr double min_stretch = 0.01;  // a cubic between positive keys may be below

/// A moment of the clip, s, and its rate in the scene: 0 where it holds, below 0 in reverse.
struct ClipTime {
  double time, speed;
};

/// `waited` s of the scene after the clip began; before that it holds its beginning.
ClipTime clip_time(const Motion& motion, double waited) {
  if (waited < 0) return {motion.start, 0};
  const double speed = motion.speed, passed = speed * waited;
  const double length = clip_length(motion);
  const bool within = passed < length;
  if (within || motion.extrapolation == Extrapolation::hold || !(length > 0))
    return {motion.start + std::min(passed, length), within ? speed : 0.0};
  if (motion.extrapolation == Extrapolation::loop)
    return {motion.start + std::fmod(passed, length), speed};
  const double position = std::fmod(passed, 2 * length);
  if (position < length) return {motion.start + position, speed};
  return {motion.start + 2 * length - position, -speed};
}

void slow_down(LocalMotion& motion, double speed) {
  if (speed == 1) return;
  motion.angular_velocity *= speed;
  motion.twist_rate *= speed;
  motion.velocity *= speed;
  motion.stretch_rate *= speed;
}

/// During the preroll: a fraction `reached` of `goal`, which grows by `rate` per second.
LocalMotion ramped(const LocalMotion& goal, double reached, double rate) {
  const Vec3 turn = rotation_vector(goal.rotation);
  LocalMotion motion;
  motion.rotation = rotation_by(reached * turn);
  motion.angular_velocity = rate * turn;
  motion.twist = reached * goal.twist;
  motion.twist_rate = rate * goal.twist;
  motion.translation = reached * goal.translation;
  motion.velocity = rate * goal.translation;
  motion.stretch = 1 + reached * (goal.stretch - 1);
  motion.stretch_rate = rate * (goal.stretch - 1);
  return motion;
}

void place(RotationCurve& curve, const Mat3& turn) {
  const Quat q(turn);
  for (auto* values : {&curve.values, &curve.in, &curve.out})
    for (Quat& value : *values) value = q * value * q.conjugate();
  for (Vec3& vector : curve.turns) vector = turn * vector;
}

void place(Curve<Vec3>& curve, double scale, const Mat3& turn) {
  for (auto* values : {&curve.values, &curve.in, &curve.out})
    for (Vec3& value : *values) value = scale * (turn * value);
}

/// Stores the shortest rotation from key to key, which each piece would otherwise compute again.
void find_turns(RotationCurve& curve) {
  if (curve.empty() || !curve.turns.empty()) return;
  std::vector<Vec3> turns = {Vec3::Zero()};
  for (std::size_t k = 1; k < curve.values.size(); ++k)
    turns.push_back(rotation_vector(curve.values[k] * curve.values[k - 1].conjugate()));
  curve.turns = std::move(turns);
}

template <class Curve, class Piece>
auto sample_of(const Curve& curve, double time, Piece& piece) {
  if (!piece.time.covers(time)) piece = curve.piece_at(time);
  return piece.at(time);
}

}  // namespace

TrackCursor::TrackCursor(const Track& track)
    : turns(!track.rotation.empty()),
      twists(!track.twist.empty()),
      shifts(!track.translation.empty()),
      stretches(!track.stretch.empty()) {}

LocalMotion Track::at(double time) const {
  TrackCursor cursor(*this);
  return at(time, cursor);
}

LocalMotion Track::at(double time, TrackCursor& cursor) const {
  LocalMotion motion;
  if (cursor.turns) {
    const auto sample = sample_of(rotation, time, cursor.rotation);
    motion.rotation = sample.value;
    motion.angular_velocity = sample.angular_velocity;
  }
  if (cursor.twists) {
    const auto sample = sample_of(twist, time, cursor.twist);
    motion.twist = sample.value;
    motion.twist_rate = sample.rate;
  }
  if (cursor.shifts) {
    const auto sample = sample_of(translation, time, cursor.translation);
    motion.translation = sample.value;
    motion.velocity = sample.rate;
  }
  if (cursor.stretches) {
    const auto sample = sample_of(stretch, time, cursor.stretch);
    const bool clamped = sample.value < min_stretch;
    motion.stretch = clamped ? min_stretch : sample.value;
    motion.stretch_rate = clamped ? 0 : sample.rate;
  }
  return motion;
}

double last_key(const Track& track) {
  double last = 0;
  for (const auto* times :
       {&track.rotation.times, &track.twist.times, &track.translation.times, &track.stretch.times})
    if (!times->empty()) last = std::max(last, times->back());
  return last;
}

double last_key(const Motion& motion) {
  double last = 0;
  for (const Track& track : motion.tracks) last = std::max(last, last_key(track));
  return last;
}

double clip_length(const Motion& motion) {
  return std::max(0.0, (motion.end ? *motion.end : last_key(motion)) - motion.start);
}

bool Track::stretches() const {
  const auto& values = stretch.values;
  return std::any_of(values.begin(), values.end(), [](double value) { return value != 1; });
}

bool stretches(const Motion& motion) {
  return std::any_of(motion.tracks.begin(), motion.tracks.end(),
                     [](const Track& track) { return track.stretches(); });
}

Motion played(Motion clip, const MotionOptions& options) {
  clip.extrapolation = options.extrapolation;
  clip.start = options.start;
  clip.end = options.end;
  clip.speed = options.speed;
  clip.preroll = options.preroll.value_or(0);
  const double last = last_key(clip);
  if (!clip.tracks.empty() && clip.start > 0 && clip.start >= clip.end.value_or(last))
    throw bad_value("start",
                    "the clip would start at " + number_text(clip.start) +
                        " s, and its last key is at " + number_text(last) + " s",
                    "give a start before that");
  for (Track& track : clip.tracks) {
    const bool cyclic = clip.extrapolation == Extrapolation::loop;
    track.rotation.cyclic = track.twist.cyclic = cyclic;
    track.translation.cyclic = track.stretch.cyclic = cyclic;
    find_turns(track.rotation);
  }
  if (!clip.end) clip.end = last;
  return clip;
}

Motion placed(Motion motion, const Placement& placement) {
  if (placement.scale == 1 && placement.turn == Mat3::Identity()) return motion;
  for (Track& track : motion.tracks) {
    place(track.rotation, placement.turn);
    place(track.translation, placement.scale, placement.turn);
  }
  return motion;
}

ClipMoment clip_moment(const Motion& motion, double time) {
  const ClipTime clip = clip_time(motion, time - motion.preroll);
  if (time >= motion.preroll || motion.preroll <= 0) return {clip.time, clip.speed};
  const double s = std::max(0.0, time / motion.preroll);
  return {clip.time, clip.speed, true, s * s * (3 - 2 * s), 6 * s * (1 - s) / motion.preroll};
}

LocalMotion local_motion(const Track& track, const ClipMoment& moment, TrackCursor& cursor) {
  LocalMotion local = track.at(moment.time, cursor);
  if (moment.ramps) return ramped(local, moment.reached, moment.rate);
  slow_down(local, moment.speed);
  return local;
}

std::vector<LocalMotion> local_motions(const Skeleton& skeleton, const Motion& motion,
                                       double time) {
  std::vector<LocalMotion> local(skeleton.size());
  const ClipMoment moment = clip_moment(motion, time);
  for (const Track& track : motion.tracks) {
    const auto bone = static_cast<std::size_t>(track.bone);
    TrackCursor cursor(track);
    local[bone] = local_motion(track, moment, cursor);
    limit(skeleton.bones[bone], local[bone]);
  }
  return local;
}

const Clip& find_clip(const std::vector<Clip>& clips, std::string_view name) {
  const auto found =
      std::find_if(clips.begin(), clips.end(), [&](const Clip& clip) { return clip.name == name; });
  if (found != clips.end()) return *found;
  std::vector<std::string_view> names;
  names.reserve(clips.size());
  for (const Clip& clip : clips) names.push_back(clip.name);
  throw bad_input("there is no clip " + shown(name),
                  names.empty() ? "give a file with an animation" : suggestion(name, names));
}

PoseCursor::PoseCursor(const Skeleton& skeleton, const Motion& motion)
    : skeleton_(&skeleton), motion_(&motion), pose_(skeleton.size()) {
  for (const Bone& bone : skeleton.bones) {
    Link link{bone.parent,  -1,          bone.limits.any(), bone.head(),
              Vec3::Zero(), bone.axis(), bone.rest.rotation};
    if (bone.parent != no_bone) {
      const Bone& parent = skeleton.bones[static_cast<std::size_t>(bone.parent)];
      link.offset = bone.head() - parent.head();
      link.along = parent.axis().dot(link.offset) * parent.axis();
    }
    links_.push_back(link);
  }
  for (const Track& track : motion.tracks) {
    links_[static_cast<std::size_t>(track.bone)].track = static_cast<int>(cursors_.size());
    cursors_.emplace_back(track);
  }
}

/// A bone without motion of its own follows its parent.
void PoseCursor::carry(const Link& link, const BonePose& parent, BonePose& pose) {
  const Vec3 offset = parent.turn * (link.offset + (parent.stretch - 1) * link.along);
  pose.turn = parent.turn;
  pose.frame.rotation = pose.turn * link.rest;
  pose.frame.origin = parent.frame.origin + offset;
  pose.velocity = parent.velocity + parent.angular_velocity.cross(offset) +
                  parent.turn * (parent.stretch_rate * link.along);
  pose.angular_velocity = parent.angular_velocity;
}

void PoseCursor::move(const Link& link, const LocalMotion& local, const BonePose& parent,
                      BonePose& pose) {
  const Mat3 rotation = parent.turn * local.rotation.toRotationMatrix();
  const Vec3 offset =
      parent.turn * (link.offset + (parent.stretch - 1) * link.along + local.translation);
  const Vec3 slide = local.velocity + parent.stretch_rate * link.along;
  pose.turn = rotation;
  pose.velocity = parent.velocity + parent.angular_velocity.cross(offset);
  pose.angular_velocity = parent.angular_velocity + parent.turn * local.angular_velocity;
  if (!slide.isZero(0)) pose.velocity += parent.turn * slide;
  if (local.twist != 0 || local.twist_rate != 0) {
    pose.turn = rotation * Eigen::AngleAxisd(local.twist, link.axis).toRotationMatrix();
    pose.angular_velocity += local.twist_rate * (rotation * link.axis);
  }
  pose.frame.rotation = pose.turn * link.rest;
  pose.frame.origin = parent.frame.origin + offset;
  pose.twist = local.twist;
  pose.stretch = local.stretch;
  pose.stretch_rate = local.stretch_rate;
}

const Pose& PoseCursor::at(double time) {
  const ClipMoment moment = clip_moment(*motion_, time);
  const BonePose scene;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    const BonePose& parent =
        link.parent == no_bone ? scene : pose_[static_cast<std::size_t>(link.parent)];
    if (link.track < 0) {
      carry(link, parent, pose_[i]);
      continue;
    }
    const auto track = static_cast<std::size_t>(link.track);
    LocalMotion local = local_motion(motion_->tracks[track], moment, cursors_[track]);
    if (link.limited) limit(skeleton_->bones[i], local);
    move(link, local, parent, pose_[i]);
  }
  return pose_;
}

Pose pose_at(const Skeleton& skeleton, const Motion& motion, double time) {
  return PoseCursor(skeleton, motion).at(time);
}

Pose rest_pose(const Skeleton& skeleton) { return pose_at(skeleton, {}, 0); }

}  // namespace sinew
