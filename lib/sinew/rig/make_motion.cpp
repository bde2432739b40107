// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/core/vector.h>
#include <sinew/rig/motion.h>

namespace sinew {
namespace {

std::string path_in_tracks(std::size_t track) { return "tracks[" + std::to_string(track) + "]"; }

std::string path_in_tracks(std::size_t track, std::size_t key) {
  return path_in_tracks(track) + ".keys[" + std::to_string(key) + "]";
}

Quat from_euler(const Vec3& angles, const std::string& order) {
  Quat rotation = Quat::Identity();  // "xyz": about x first, then y, then z, in fixed directions
  for (const char name : order) {
    const int axis = name - 'x';
    rotation = Eigen::AngleAxisd(radians(angles[axis]), Vec3::Unit(axis)) * rotation;
  }
  return rotation;
}

constexpr double largest_rounding = 1e-3;  // error of a quaternion's length: more is not rounding

Quat from_quaternion(const std::array<double, 4>& given, const std::string& place) {
  const Quat rotation(given[0], given[1], given[2], given[3]);
  const double length = rotation.norm();
  if (!(std::abs(length - 1) <= largest_rounding))
    throw bad_value(place, "a quaternion of length " + number_text(length) + " is no rotation",
                    "give [w, x, y, z] of length 1");
  return rotation.normalized();
}

Quat rotation_of(const KeyDefinition& key, const std::string& order, const std::string& place) {
  const int forms =
      (key.euler ? 1 : 0) + (key.quaternion ? 1 : 0) + (key.axis || key.angle ? 1 : 0);
  if (forms > 1)
    throw bad_value(place, "a key gives its rotation twice",
                    "keep one of euler, quaternion, and axis and angle");
  if (key.euler) return from_euler(*key.euler, order);
  if (key.quaternion) return from_quaternion(*key.quaternion, place);
  if (key.axis && !key.angle)
    throw bad_value(place, "an axis without an angle", "give angle: DEGREES");
  if (!key.angle) return Quat::Identity();
  if (!key.axis || key.axis->norm() == 0)
    throw bad_value(place, "an angle without an axis", "give axis: [x, y, z], not all zero");
  return Quat(Eigen::AngleAxisd(radians(*key.angle), key.axis->normalized()));
}

/// Whether a key has a rotation; euler angles of 0 are none.
bool is_turned(const KeyDefinition& key) {
  const bool by_quaternion = key.quaternion && *key.quaternion != std::array<double, 4>{1, 0, 0, 0};
  return key.angle || by_quaternion || (key.euler && !key.euler->isZero(0));
}

/// The angle of a key about `axis`, if given in that form; no rotation is no angle.
std::optional<double> angle_about(const Vec3& axis, const KeyDefinition& key) {
  if (!is_turned(key)) return 0;
  if (!key.axis || (key.axis->normalized() - axis).norm() > 1e-12) return std::nullopt;
  return radians(*key.angle);
}

/// Turns from one key to the next: by angles about one axis as given, of any size; otherwise by the
/// shortest rotation.
Vec3 turn_between(const KeyDefinition& from, const KeyDefinition& to, const Quat& start,
                  const Quat& end) {
  const auto given = to.axis ? to.axis : from.axis;
  if (given) {
    const Vec3 axis = given->normalized();
    const auto before = angle_about(axis, from), after = angle_about(axis, to);
    if (before && after) return (*after - *before) * axis;
  }
  return rotation_vector(end * start.conjugate());
}

void check_order(const TrackDefinition& track, const std::string& place) {
  std::string sorted = track.order;
  std::sort(sorted.begin(), sorted.end());
  if (sorted != "xyz")
    throw bad_value(place, "'" + track.order + "' is no order of euler angles",
                    "use xyz, xzy, yxz, yzx, zxy or zyx");
}

double time_of(std::optional<double> frame_rate, const KeyDefinition& key,
               const std::string& path) {
  if (key.time && key.frame)
    throw bad_value(path + ".frame", "a key gives its time twice", "keep one of time and frame");
  if (key.time) return *key.time;
  if (!key.frame)
    throw bad_value(path, path + ".time is missing", "add time: SECONDS, or frame: NUMBER");
  if (!frame_rate)
    throw bad_value(path + ".frame", "a key in frames, but the frame rate is unknown",
                    "give motion: frame_rate: as in 30, or time: instead of frame:");
  return *key.frame / *frame_rate;
}

/// The keys' times, s.
std::vector<double> times_of(const TrackDefinition& track, std::size_t index,
                             std::optional<double> frame_rate) {
  std::vector<double> times;
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    const KeyDefinition& key = track.keys[i];
    const std::string path = path_in_tracks(index, i);
    const double time = time_of(frame_rate, key, path);
    if (i > 0 && !(time > times.back()))
      throw bad_value(path + (key.frame ? ".frame" : ".time"), "keys are not in ascending time",
                      "sort them, each with its own time");
    times.push_back(time);
  }
  if (times.empty())
    throw bad_value(path_in_tracks(index), "a track without keys", "give it keys, or remove it");
  return times;
}

RotationCurve rotation_curve(const TrackDefinition& track, std::size_t index) {
  RotationCurve curve;
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    const KeyDefinition& key = track.keys[i];
    const Quat rotation = rotation_of(key, track.order, (path_in_tracks(index, i)));
    curve.turns.push_back(
        i > 0 ? turn_between(track.keys[i - 1], key, curve.values.back(), rotation) : Vec3::Zero());
    curve.values.push_back(rotation);
  }
  return curve;
}

template <class Value, class Of>
Curve<Value> curve_of(const TrackDefinition& track, Of&& of) {
  Curve<Value> curve;
  for (const KeyDefinition& key : track.keys) curve.values.push_back(of(key));
  return curve;
}

int bone_of(const TrackDefinition& track, std::size_t index, const Skeleton& skeleton,
            const Motion& earlier) {
  const std::string& name = track.bone;
  const std::string key = path_in_tracks(index) + ".bone";
  const int bone = bone_named(skeleton, name, key);
  for (const Track& one : earlier.tracks)
    if (one.bone == bone)
      throw bad_value(key, "bone '" + name + "' has two tracks", "put all its keys into one");
  return bone;
}

/// Twist, translation and stretch are curves only where a key gives them.
Track make_track(const TrackDefinition& given, std::size_t index,
                 std::optional<double> frame_rate) {
  const std::vector<double> times = times_of(given, index, frame_rate);
  const auto any = [&](auto&& says) {
    return std::any_of(given.keys.begin(), given.keys.end(), says);
  };
  Track track;
  track.rotation = rotation_curve(given, index);
  if (any([](const KeyDefinition& key) { return key.twist != 0; }))
    track.twist = curve_of<double>(given, [](const auto& key) { return radians(key.twist); });
  if (any([](const KeyDefinition& key) { return key.translation != Vec3::Zero(); }))
    track.translation = curve_of<Vec3>(given, [](const auto& key) { return key.translation; });
  if (any([](const KeyDefinition& key) { return key.stretch != 1; }))
    track.stretch = curve_of<double>(given, [](const auto& key) { return key.stretch; });
  const auto finish = [&](auto& curve) {
    curve.interpolation = given.interpolation;
    if (!curve.values.empty()) curve.times = times;
  };
  finish(track.rotation), finish(track.twist), finish(track.translation), finish(track.stretch);
  return track;
}

}  // namespace

Motion make_motion(std::span<const TrackDefinition> tracks, const Skeleton& skeleton,
                   std::optional<double> frame_rate) {
  Motion motion;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    check_order(tracks[i], path_in_tracks(i) + ".order");
    const int bone = bone_of(tracks[i], i, skeleton, motion);
    motion.tracks.push_back(make_track(tracks[i], i, frame_rate));
    motion.tracks.back().bone = bone;
  }
  return motion;
}

KeyDefinition key_of(const LocalMotion& motion, double time) {
  const Quat& q = motion.rotation;
  KeyDefinition key;
  key.time = time;
  key.quaternion = {q.w(), q.x(), q.y(), q.z()};
  key.twist = degrees(motion.twist);
  key.translation = motion.translation;
  key.stretch = motion.stretch;
  return key;
}

TrackDefinition track_of(std::string bone, std::span<const double> times,
                         std::span<const Quat> rotations) {
  if (times.size() != rotations.size())
    throw bad_input("bone " + shown(bone) + " has " + std::to_string(rotations.size()) +
                        " rotations at " + std::to_string(times.size()) + " times",
                    "give a time for each");
  TrackDefinition track;
  track.bone = std::move(bone);
  track.interpolation = Interpolation::linear;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const Quat& q = rotations[k];
    KeyDefinition key;
    key.time = times[k];
    key.quaternion = std::array<double, 4>{q.w(), q.x(), q.y(), q.z()};
    track.keys.push_back(key);
  }
  return track;
}

}  // namespace sinew
