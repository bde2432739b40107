// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/motion.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sinew {
namespace {

struct Eased {
  double value, rate;  // of the way from one key to the next, 0 to 1, and per unit of time
};

Eased ease(Interpolation interpolation, double s, double duration) {
  switch (interpolation) {
    case Interpolation::step:
      return {0, 0};
    case Interpolation::linear:
      return {s, 1 / duration};
    case Interpolation::smooth:
      return {s * s * (3 - 2 * s), 6 * s * (1 - s) / duration};
  }
  return {};
}

LocalMotion held(const Key& key) {
  LocalMotion motion;
  motion.rotation = key.rotation;
  motion.twist = key.twist;
  motion.translation = key.translation;
  return motion;
}

/// The rotation vector of the short way from `from` to `to`, in the directions both are given in.
Vec3 rotation_between(const Quat& from, const Quat& to) {
  Quat step = to * from.conjugate();
  if (step.w() < 0) step.coeffs() *= -1;
  const double sine = step.vec().norm();
  if (sine == 0) return Vec3::Zero();
  return step.vec() * (2 * std::atan2(sine, step.w()) / sine);
}

Quat rotation_by(const Vec3& vector) {
  const double angle = vector.norm();
  return angle == 0 ? Quat::Identity() : Quat(Eigen::AngleAxisd(angle, vector / angle));
}

LocalMotion between(const Key& from, const Key& to, const Eased& way) {
  LocalMotion motion;
  motion.rotation = rotation_by(way.value * to.turn) * from.rotation;
  motion.angular_velocity = way.rate * to.turn;
  motion.twist = from.twist + way.value * (to.twist - from.twist);
  motion.twist_rate = way.rate * (to.twist - from.twist);
  motion.translation = from.translation + way.value * (to.translation - from.translation);
  motion.velocity = way.rate * (to.translation - from.translation);
  return motion;
}

BonePose move(const Bone& bone, const LocalMotion& local, const BonePose& parent,
              const Vec3& parent_head) {
  const Mat3 rotation = parent.turn * local.rotation.toRotationMatrix();
  const Vec3 offset = parent.turn * (bone.head() - parent_head + local.translation);
  const Vec3 axis = rotation * bone.axis();
  BonePose pose;
  pose.turn = rotation * Eigen::AngleAxisd(local.twist, bone.axis()).toRotationMatrix();
  pose.frame.rotation = pose.turn * bone.rest.rotation;
  pose.frame.origin = parent.frame.origin + offset;
  pose.velocity =
      parent.velocity + parent.angular_velocity.cross(offset) + parent.turn * local.velocity;
  pose.angular_velocity =
      parent.angular_velocity + parent.turn * local.angular_velocity + local.twist_rate * axis;
  pose.twist = local.twist;
  return pose;
}

std::string path_of(std::size_t track) { return "motion.tracks[" + std::to_string(track) + "]"; }

std::string path_of(std::size_t track, std::size_t key) {
  return path_of(track) + ".keys[" + std::to_string(key) + "]";
}

Quat from_euler(const Vec3& angles, const std::string& order) {
  Quat rotation = Quat::Identity();  // "xyz": about x first, then y, then z, in fixed directions
  for (const char name : order) {
    const int axis = name - 'x';
    rotation = Eigen::AngleAxisd(radians(angles[axis]), Vec3::Unit(axis)) * rotation;
  }
  return rotation;
}

Quat rotation_of(const KeySettings& key, const std::string& order, const Place& place) {
  if (key.euler && (key.axis || key.angle))
    throw bad_input(place, "a key gives its rotation twice", "keep either euler or axis and angle");
  if (key.euler) return from_euler(*key.euler, order);
  if (key.axis && !key.angle)
    throw bad_input(place, "an axis without an angle", "give angle: DEGREES");
  if (!key.angle) return Quat::Identity();
  if (!key.axis || key.axis->norm() == 0)
    throw bad_input(place, "an angle without an axis", "give axis: [x, y, z], not all zero");
  return Quat(Eigen::AngleAxisd(radians(*key.angle), key.axis->normalized()));
}

/// The angle of a key about `axis`, if that is how it is given; no rotation is no angle.
std::optional<double> angle_about(const Vec3& axis, const KeySettings& key) {
  if (!key.angle && !key.euler) return 0;
  if (!key.axis || (key.axis->normalized() - axis).norm() > 1e-12) return std::nullopt;
  return radians(*key.angle);
}

/// From one key to the next: angles about one axis as they are given, of any size; else the short
/// way.
Vec3 turn_between(const KeySettings& from, const KeySettings& to, const Quat& start,
                  const Quat& end) {
  const auto given = to.axis ? to.axis : from.axis;
  if (given) {
    const Vec3 axis = given->normalized();
    const auto before = angle_about(axis, from), after = angle_about(axis, to);
    if (before && after) return (*after - *before) * axis;
  }
  return rotation_between(start, end);
}

void check_order(const TrackSettings& track, const Place& place) {
  std::string sorted = track.order;
  std::sort(sorted.begin(), sorted.end());
  if (sorted != "xyz")
    throw bad_input(place, "'" + track.order + "' is no order of euler angles",
                    "use xyz, xzy, yxz, yzx, zxy or zyx");
}

std::vector<Key> make_keys(const Settings& settings, std::size_t index) {
  const TrackSettings& track = settings.tracks[index];
  std::vector<Key> keys;
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    const KeySettings& given = track.keys[i];
    const Place place = settings.place(path_of(index, i));
    if (i > 0 && given.time <= keys.back().time)
      throw bad_input(settings.place(path_of(index, i) + ".time"), "keys are not in ascending time",
                      "sort them, each with its own time");
    const Quat rotation = rotation_of(given, track.order, place);
    const Vec3 turn = i > 0 ? turn_between(track.keys[i - 1], given, keys.back().rotation, rotation)
                            : Vec3::Zero();
    keys.push_back({given.time, rotation, turn, radians(given.twist), given.translation});
  }
  if (keys.empty())
    throw bad_input(settings.place(path_of(index)), "a track without keys",
                    "give it keys, or remove it");
  return keys;
}

int bone_of(const Settings& settings, std::size_t index, const Skeleton& skeleton,
            const Motion& earlier) {
  const std::string& name = settings.tracks[index].bone;
  const Place place = settings.place(path_of(index) + ".bone");
  const auto found = std::find_if(skeleton.bones.begin(), skeleton.bones.end(),
                                  [&](const Bone& bone) { return bone.name == name; });
  if (found == skeleton.bones.end())
    throw bad_input(place, "there is no bone '" + name + "'", "use a name from skeleton.bones");
  const int bone = static_cast<int>(found - skeleton.bones.begin());
  for (const Track& track : earlier.tracks)
    if (track.bone == bone)
      throw bad_input(place, "bone '" + name + "' has two tracks", "put all its keys into one");
  return bone;
}

}  // namespace

LocalMotion Track::at(double time) const {
  const auto next = std::upper_bound(keys.begin(), keys.end(), time,
                                     [](double t, const Key& key) { return t < key.time; });
  if (next == keys.begin()) return held(keys.front());
  if (next == keys.end()) return held(keys.back());
  const Key& from = *(next - 1);
  const double duration = next->time - from.time;
  return between(from, *next, ease(interpolation, (time - from.time) / duration, duration));
}

Motion make_motion(const Settings& settings, const Skeleton& skeleton) {
  Motion motion;
  for (std::size_t i = 0; i < settings.tracks.size(); ++i) {
    check_order(settings.tracks[i], settings.place(path_of(i) + ".order"));
    Track track;
    track.bone = bone_of(settings, i, skeleton, motion);
    track.interpolation = settings.tracks[i].interpolation;
    track.keys = make_keys(settings, i);
    motion.tracks.push_back(std::move(track));
  }
  return motion;
}

Pose pose_at(const Skeleton& skeleton, const Motion& motion, double time) {
  std::vector<LocalMotion> local(skeleton.size());
  for (const Track& track : motion.tracks) local[track.bone] = track.at(time);
  const BonePose scene;
  Pose pose;
  pose.reserve(skeleton.size());
  for (std::size_t i = 0; i < skeleton.size(); ++i) {
    const Bone& bone = skeleton.bones[i];
    const bool root = bone.parent == no_bone;
    pose.push_back(move(bone, local[i], root ? scene : pose[bone.parent],
                        root ? Vec3::Zero() : skeleton.bones[bone.parent].head()));
  }
  return pose;
}

Pose rest_pose(const Skeleton& skeleton) { return pose_at(skeleton, {}, 0); }

}  // namespace sinew
