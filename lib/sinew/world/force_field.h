// SPDX-License-Identifier: GPL-3.0-or-later
// Forces that fill a region of space: wind, attraction, suction, a vortex; the drag of a medium.
//
//     const ForceField wind{"wind", UniformAcceleration{{3, 0, 0}}, region, {}};
//     const Vec3 force = field_force(wind, wind.scale.at(time), position, grain);
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <variant>

#include <sinew/world/region.h>

namespace sinew {

struct UniformAcceleration {
  Vec3 acceleration = Vec3::Zero();  ///< m/s^2
};

struct ForceDensity {
  Vec3 density = Vec3::Zero();  ///< N per m^3 of the body at rest
};

/// Towards a point at constant acceleration; inside `core`, proportional to the distance.
struct Attraction {
  Vec3 point = Vec3::Zero();  ///< m
  double acceleration = 0;    ///< m/s^2; negative pushes away
  double core = 0;            ///< m, > 0
};

/// Around an axis, right-handed, at constant acceleration; proportional to distance inside `core`.
struct Swirl {
  Vec3 point = Vec3::Zero();  ///< place on the axis, m
  Vec3 axis = Vec3::UnitZ();  ///< direction of any length but 0
  double acceleration = 0;    ///< m/s^2
  double core = 0;            ///< m, > 0
};

/// A particle as fields see it.
struct ParticleInfo {
  double mass;    ///< kg
  double volume;  ///< volume in the body at rest, m^3
  std::size_t id = 0;
};

/// A force of one's own. It is called from several threads at once.
struct CustomForce {
  std::function<Vec3(const Vec3& position, const ParticleInfo& grain)> force;  ///< N
  double largest = 0;                                       ///< bound of its size, N
  double length = std::numeric_limits<double>::infinity();  ///< over which it changes by as much, m
};

using FieldForm = std::variant<UniformAcceleration, ForceDensity, Attraction, Swirl, CustomForce>;

struct ForceField {
  std::string name;
  FieldForm form;
  Region region;
  KeyedValue scale;  ///< over time; 1 without keys
};

/// A medium moving at constant velocity brakes the particles: f = -rate m (v - velocity).
struct Drag {
  double rate = 0;               ///< 1/s
  Vec3 velocity = Vec3::Zero();  ///< velocity of the medium, m/s
};

/// The force on a particle at `position`, N, with the keys' value `scale`.
Vec3 field_force(const ForceField& field, double scale, const Vec3& position,
                 const ParticleInfo& grain);

/// An upper bound of the force's gradient at any time, N/m. The edge of a region without falloff is
/// left out: a particle crosses it in no time.
double field_stiffness(const ForceField& field, const ParticleInfo& grain);

/// Throws bad input for numbers that are not finite, cores that are not positive, an axis without
/// direction, and bad regions or keys.
void check_field(const ForceField& field);
void check_drag(const Drag& drag);

}  // namespace sinew
