// SPDX-License-Identifier: GPL-3.0-or-later
// Solids that push particles out: a spring along the normal, damped approach and dry friction.
//
//     const Contact touch = contact(obstacle, obstacle.at(time, pose), position, velocity, radius);
//     force += touch.force();
//
// A particle of radius r whose center is nearer than r to the surface (d < r, however deep inside)
// is subject to, with its velocity v relative to the obstacle's point at its center and n the
// outward normal,
//   f_n = k (r - d) + c max(0, -v.n)       never pulls
//   f_t = -min(mu f_n / |v_t|, s) v_t      Coulomb's law, regularized
// A damping s (kg/s, "stick") makes sliding below the speed mu f_n / s viscous: the force depends
// on the state alone and adds a rate s / m that the step must resolve (s = m / (2 step) keeps the
// usual half of the limit), but a load creeps at load / s. Without s, friction acts only through
// a force of world_on() that depends on the step: contacts stick, and need no shorter step.
// An obstacle thinner than about 2r pushes a particle that passed its middle out on the far side.
#pragma once

#include <functional>
#include <string>

#include <sinew/core/vector.h>
#include <sinew/rig/pose.h>
#include <sinew/world/region.h>
#include <sinew/world/shapes.h>

namespace sinew {

/// Where an obstacle is and how it moves.
struct ObstaclePose {
  RigidFrame frame;                      ///< maps the shape's coordinates to the scene's
  Vec3 velocity = Vec3::Zero();          ///< velocity of the frame's origin, m/s
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s
  double friction = 1;                   ///< factor on the obstacle's

  /// Velocity of the point of this rigid obstacle that is at `p` now, m/s.
  Vec3 velocity_at(const Vec3& p) const {
    return velocity + angular_velocity.cross(p - frame.origin);
  }
};

/// The pose at a time (s), when the bones are at the given pose.
using ObstacleMotion = std::function<ObstaclePose(double, const Pose&)>;

struct Obstacle {
  std::string name;
  Shape shape;
  ObstacleMotion motion;           ///< none: shape coordinates are scene coordinates
  double stiffness = 0;            ///< k, N/m
  double damping = 0;              ///< c, kg/s
  double friction = 0;             ///< mu
  double stick = 0;                ///< s, kg/s; 0: friction stops what slides in a step
  int bone = no_bone;              ///< on which it rides, by its motion
  KeyedValue friction_scale = {};  ///< over time; 1 without keys

  ObstaclePose at(double time, const Pose& pose) const;
};

/// Always at `frame`.
ObstacleMotion still(const RigidFrame& frame);

/// Attached to a bone: `frame` is the obstacle's frame while bone number `bone` of a skeleton is at
/// its rest frame `rest`.
ObstacleMotion attached_to_bone(int bone, const Bone& rest, const RigidFrame& frame);

/// The force of an obstacle on one particle, N, and the energy k (r - d)^2 / 2 it stores, J.
struct Contact {
  Vec3 spring = Vec3::Zero(), damping = Vec3::Zero(), friction = Vec3::Zero();
  double energy = 0;
  Vec3 normal = Vec3::Zero();  ///< outward; zero without contact
  double pressing = 0;         ///< f_n, N

  Vec3 force() const { return spring + damping + friction; }
  Vec3 losing() const { return damping + friction; }
};

/// The contact of a particle of `radius` (m) with an obstacle at `pose`.
Contact contact(const Obstacle& obstacle, const ObstaclePose& pose, const Vec3& position,
                const Vec3& velocity, double radius);

/// The friction, N, that stops the sliding of a particle of `mass` (kg) within a step (s), or mu
/// f_n where that is less. `relative` (m/s) is its velocity at the end of that step without
/// friction, relative to the obstacle's point there; `friction`: factor on the obstacle's.
Vec3 stopping_friction(const Obstacle& obstacle, double friction, const Contact& touch,
                       const Vec3& relative, double mass, double step);

/// Throws bad input for a bad shape, and for constants that are negative or not finite.
void check_obstacle(const Obstacle& obstacle);

}  // namespace sinew
