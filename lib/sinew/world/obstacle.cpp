// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/obstacle.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

void check_constant(const Obstacle& obstacle, const std::string& key, double value) {
  if (is_computable(value) && value >= 0) return;
  throw bad_input("obstacle '" + obstacle.name + "' has a " + key + " of " + number_text(value),
                  "give 0 or a positive number");
}

/// Coulomb's law, with a slope in the velocity of at most `stick`.
Vec3 rub(double max_force, double stick, const Vec3& sliding) {
  const double speed = sliding.norm();
  if (!(speed > 0)) return Vec3::Zero();
  return -std::min(max_force / speed, stick) * sliding;
}

}  // namespace

ObstaclePose Obstacle::at(double time, const Pose& pose) const {
  ObstaclePose now = motion ? motion(time, pose) : ObstaclePose{};
  now.friction = friction_scale.at(time);
  return now;
}

ObstacleMotion still(const RigidFrame& frame) {
  return [frame](double, const Pose&) {
    ObstaclePose pose;
    pose.frame = frame;
    return pose;
  };
}

ObstacleMotion attached_to_bone(int bone, const Bone& rest, const RigidFrame& frame) {
  return [bone, rest = rest.rest, frame](double, const Pose& bones) {
    const BonePose& comoving_frame = bones.at(static_cast<std::size_t>(bone));
    ObstaclePose pose;
    pose.frame.origin = carried(frame.origin, rest, comoving_frame.frame);
    pose.frame.rotation = comoving_frame.turn * frame.rotation;
    pose.velocity = comoving_frame.velocity_at(pose.frame.origin);
    pose.angular_velocity = comoving_frame.angular_velocity;
    return pose;
  };
}

Contact contact(const Obstacle& obstacle, const ObstaclePose& pose, const Vec3& position,
                const Vec3& velocity, double radius) {
  const Vec3 local = pose.frame.rotation.transpose() * (position - pose.frame.origin);
  if (!may_be_within(obstacle.shape, local, radius)) return {};
  const SignedDistance nearest = signed_distance(obstacle.shape, local);
  const double depth = radius - nearest.distance;
  if (!(depth > 0)) return {};
  const Vec3 normal = pose.frame.rotation * nearest.normal;
  const Vec3 relative = velocity - pose.velocity_at(position);
  const double leaving = normal.dot(relative);
  const double spring = obstacle.stiffness * depth;
  const double brake = obstacle.damping * std::max(0.0, -leaving);
  Contact touch;
  touch.normal = normal;
  touch.pressing = spring + brake;
  touch.spring = spring * normal;
  touch.damping = brake * normal;
  touch.friction = rub(pose.friction * obstacle.friction * touch.pressing, obstacle.stick,
                       relative - leaving * normal);
  touch.energy = spring * depth / 2;
  return touch;
}

Vec3 stopping_friction(const Obstacle& obstacle, double friction, const Contact& touch,
                       const Vec3& relative, double mass, double step) {
  const Vec3 sliding = relative - touch.normal.dot(relative) * touch.normal;
  return rub(friction * obstacle.friction * touch.pressing, mass / step, sliding);
}

void check_obstacle(const Obstacle& obstacle) {
  check_shape(obstacle.shape, "obstacle '" + obstacle.name + "'");
  check_constant(obstacle, "stiffness", obstacle.stiffness);
  check_constant(obstacle, "damping", obstacle.damping);
  check_constant(obstacle, "friction", obstacle.friction);
  check_constant(obstacle, "stick", obstacle.stick);
  check_keys(obstacle.friction_scale, 0, std::numeric_limits<double>::max(),
             "obstacle '" + obstacle.name + "'");
}

}  // namespace sinew
