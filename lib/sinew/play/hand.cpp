// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/play/hand.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/rig/motion_checks.h>

namespace sinew {
namespace {

constexpr std::size_t max_undone = 20;
constexpr int rounds_of_reaching = 12;

/// The move within an interval towards what is `left`, at a speed that changes evenly in size and
/// direction, so that it stops there.
Vec3 stride(const Vec3& left, double max_speed, double growth, double interval, Vec3& speed) {
  const double distance = left.norm(), change = growth * interval;
  if (distance <= change * interval && speed.norm() <= 2 * change) {
    speed = Vec3::Zero();
    return left;
  }
  // The largest from which it can stop there, in whole intervals.
  const double stopping = change / 2 * (std::sqrt(1 + 8 * distance / (change * interval)) - 1);
  const Vec3 wanted = std::min(max_speed, stopping) / distance * left;
  const Vec3 more = wanted - speed;
  speed += std::min(1.0, change / std::max(more.norm(), 1e-300)) * more;
  return interval * speed;
}

void check(const Vec3& place) {
  if (!is_computable(place)) throw bad_input("a place is not finite", "give three numbers, in m");
}

/// The rotation of a pose's bone in the directions of its parent, without its twist.
Quat local_rotation(const Skeleton& skeleton, const Pose& pose, int bone, const Mat3& turn) {
  const int parent = skeleton.bones[static_cast<std::size_t>(bone)].parent;
  return parent == no_bone
             ? Quat(turn)
             : Quat(Mat3(pose[static_cast<std::size_t>(parent)].turn.transpose() * turn));
}

Vec3 tip(const Skeleton& skeleton, const Pose& pose, int bone) {
  const auto b = static_cast<std::size_t>(bone);
  return pose[b].frame.origin + pose[b].stretch * skeleton.bones[b].length * pose[b].axis();
}

Mat3 turn_from(const Vec3& from, const Vec3& to) {
  if (from.norm() == 0 || to.norm() == 0) return Mat3::Identity();
  return Quat::FromTwoVectors(from, to).toRotationMatrix();
}

}  // namespace

Pose pose_of(const Skeleton& skeleton, const BoneKeys& keys) {
  Motion still;
  for (std::size_t b = 0; b < keys.size(); ++b) {
    Track track;
    track.bone = static_cast<int>(b);
    track.rotation = {Interpolation::step, {0}, {keys[b].rotation}, {Vec3::Zero()}, {}, {}, false};
    track.twist = {Interpolation::step, {0}, {keys[b].twist}, {}, {}, false};
    track.translation = {Interpolation::step, {0}, {keys[b].translation}, {}, {}, false};
    still.tracks.push_back(std::move(track));
  }
  return pose_at(skeleton, still, 0);
}

Hand::Hand(Skeleton skeleton, HandSpeed speed)
    : skeleton_(std::move(skeleton)), speed_(speed), ways_(skeleton_.size()) {}

Hand::Way& Hand::touch(int bone, const BoneKeys& now) {
  if (bone < 0 || static_cast<std::size_t>(bone) >= skeleton_.size())
    throw bad_input("there is no bone " + std::to_string(bone),
                    "give a number from 0 to " + std::to_string(skeleton_.size() - 1));
  const auto b = static_cast<std::size_t>(bone);
  if (!ways_[b]) ways_[b] = Way{now[b].rotation, now[b].translation};
  return *ways_[b];
}

void Hand::set_rotation(int bone, const Quat& rotation, const BoneKeys& now) {
  LocalMotion limited;
  limited.rotation = rotation.normalized();
  limited.twist = now[static_cast<std::size_t>(bone)].twist;
  limit(skeleton_.bones[static_cast<std::size_t>(bone)], limited);
  Way& way = touch(bone, now);
  way.rotation = limited.rotation;
  way.spins = false;
}

void Hand::aim(int bone, const Vec3& to, const BoneKeys& now) {
  check(to);
  touch(bone, now);
  const Pose pose = pose_of(skeleton_, now);
  const auto b = static_cast<std::size_t>(bone);
  const Mat3 turn = turn_from(pose[b].axis(), to - pose[b].frame.origin) * pose[b].turn;
  LocalMotion straight = now[b];
  const Quat untwisted = local_rotation(skeleton_, pose, bone, turn) *
                         Quat(Eigen::AngleAxisd(-straight.twist, skeleton_.bones[b].axis()));
  set_rotation(bone, untwisted, now);
}

/// Cyclic coordinate descent (Wang and Chen 1991): each bone in turn looks to the place.
void Hand::reach(int bone, const Vec3& to, const BoneKeys& now) {
  check(to);
  touch(bone, now);
  BoneKeys keys = now;
  for (int round = 0; round < rounds_of_reaching; ++round)
    for (int one = bone; one != no_bone;
         one = skeleton_.bones[static_cast<std::size_t>(one)].parent) {
      const auto b = static_cast<std::size_t>(one);
      const Pose pose = pose_of(skeleton_, keys);
      const Vec3 head = pose[b].frame.origin;
      const Mat3 turn = turn_from(tip(skeleton_, pose, bone) - head, to - head) * pose[b].turn;
      keys[b].rotation = (local_rotation(skeleton_, pose, one, turn) *
                          Quat(Eigen::AngleAxisd(-keys[b].twist, skeleton_.bones[b].axis())))
                             .normalized();
      limit(skeleton_.bones[b], keys[b]);
    }
  for (int one = bone; one != no_bone; one = skeleton_.bones[static_cast<std::size_t>(one)].parent)
    set_rotation(one, keys[static_cast<std::size_t>(one)].rotation, now);
}

void Hand::move(int bone, const Vec3& to, const BoneKeys& now) {
  check(to);
  Way& way = touch(bone, now);
  const Bone& one = skeleton_.bones[static_cast<std::size_t>(bone)];
  if (one.parent != no_bone)
    throw bad_input("bone '" + one.name + "' hangs on another", "move the one without a parent");
  way.translation = to - one.head();
}

void Hand::turn(int bone, const Vec3& axis, double angle, const BoneKeys& now) {
  if (!is_computable(axis) || axis.norm() == 0 || !is_computable(angle))
    throw bad_input("a turn without an axis or an angle", "give an axis [x, y, z], not all zero");
  Way& way = touch(bone, now);
  const Pose pose = pose_of(skeleton_, now);
  const int parent = skeleton_.bones[static_cast<std::size_t>(bone)].parent;
  const Mat3 above =
      parent == no_bone ? Mat3::Identity() : pose[static_cast<std::size_t>(parent)].turn;
  way.spin = angle * (above.transpose() * axis.normalized());
  way.rotation =
      (rotation_by(way.spin) * now[static_cast<std::size_t>(bone)].rotation).normalized();
  way.spins = true;
}

void Hand::grab() {
  if (before_.size() == max_undone) before_.erase(before_.begin());
  before_.push_back(ways_);
}

/// Bones that were untouched before stay where they are: their clip has gone on.
bool Hand::undo() {
  if (before_.empty()) return false;
  for (std::size_t b = 0; b < ways_.size(); ++b)
    if (before_.back()[b]) ways_[b] = before_.back()[b];
  before_.pop_back();
  return true;
}

bool Hand::has(int bone) const { return ways_[static_cast<std::size_t>(bone)].has_value(); }

bool Hand::is_there(int bone, const BoneKeys& now) const {
  const auto b = static_cast<std::size_t>(bone);
  if (!ways_[b]) return true;
  const Vec3 left = rotation_vector(ways_[b]->rotation * now[b].rotation.conjugate());
  return !ways_[b]->spins && left.norm() < 1e-12 && now[b].translation == ways_[b]->translation;
}

void Hand::hold(const BoneKeys& now) {
  for (std::size_t b = 0; b < ways_.size(); ++b)
    ways_[b] = Way{now[b].rotation, now[b].translation};
}

void Hand::approach(Way& way, LocalMotion& key, double interval, double share) const {
  const Vec3 left = way.spins ? way.spin : rotation_vector(way.rotation * key.rotation.conjugate());
  if (left.norm() > 0) {
    const Vec3 by =
        stride(left, share * speed_.turn, speed_.turn / speed_.ramp, interval, way.turning);
    way.spin = left - by;
    way.spins = way.spins && way.spin.norm() > pi / 2;  // ends by the shortest way
    key.rotation =
        by == left && !way.spins ? way.rotation : (rotation_by(by) * key.rotation).normalized();
  }
  const Vec3 shift = way.translation - key.translation;
  if (shift.norm() > 0) {
    const Vec3 by = stride(shift, speed_.shift, speed_.shift / speed_.ramp, interval, way.shifting);
    key.translation = by == shift ? way.translation : Vec3(key.translation + by);
  }
}

/// Bones that turn one above the other share the speed: no tip is faster than one bone may be.
std::vector<int> Hand::turning_above(const BoneKeys& now) const {
  std::vector<int> count(ways_.size(), 0), most(ways_.size(), 0);
  for (std::size_t b = 0; b < ways_.size(); ++b) {
    const int parent = skeleton_.bones[b].parent;
    count[b] = (parent == no_bone ? 0 : count[static_cast<std::size_t>(parent)]) +
               (is_there(static_cast<int>(b), now) ? 0 : 1);
    most[b] = count[b];
  }
  for (std::size_t b = ways_.size(); b-- > 0;)
    if (const int parent = skeleton_.bones[b].parent; parent != no_bone)
      most[static_cast<std::size_t>(parent)] =
          std::max(most[static_cast<std::size_t>(parent)], most[b]);
  return most;
}

BoneKeys Hand::next(BoneKeys now, double interval) {
  const std::vector<int> sharing = turning_above(now);
  for (std::size_t b = 0; b < ways_.size(); ++b)
    if (ways_[b]) approach(*ways_[b], now[b], interval, 1.0 / std::max(1, sharing[b]));
  return now;
}

}  // namespace sinew
