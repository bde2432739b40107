// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/body/bone_force.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/particles.h>

namespace sinew {
namespace {

// Closer to the bone than this fraction of a radius, a particle has no direction from it.
constexpr double on_axis = 1e-6;

struct Spring {
  Vec3 force;
  double energy;
};

/// Where the bone has moved the particle's foot and its place at rest.
struct Carried {
  Vec3 foot, target;
};

Carried carry(const Influence& influence, const Bone& bone, const BonePose& pose,
              const Vec3& rest) {
  return {carried_foot(influence, bone, pose), pose.carried(rest, bone)};
}

Spring to_point(double k, const Vec3& offset) {
  return {-k * offset, k * offset.squaredNorm() / 2};
}

Spring radial(double k, const Vec3& offset, double rest_distance, double radius) {
  if (rest_distance < on_axis * radius) return to_point(k, offset);
  const double distance = offset.norm();
  const double stretch = distance - rest_distance;
  if (distance == 0) return {Vec3::Zero(), k * stretch * stretch / 2};
  return {-k * stretch / distance * offset, k * stretch * stretch / 2};
}

/// U = k rho0^2 s^2 G(alpha), alpha the angle about `axis` from `wanted` to `actual` (both across
/// the axis), s = min(1, 2 |rho| / rho0): the taper keeps the force finite on the axis.
Spring twist_servo(double k, const Vec3& axis, const Vec3& wanted, const Vec3& actual,
                   double radius) {
  const double rho0 = wanted.norm(), rho = actual.norm();
  if (rho0 < on_axis * radius || rho == 0) return {Vec3::Zero(), 0};
  const double alpha = std::atan2(axis.dot(wanted.cross(actual)), wanted.dot(actual));
  const TwistEnergy G = twist_energy(alpha);
  const double taper = std::min(1.0, 2 * rho / rho0);
  const double taper_slope = taper < 1 ? 2 / rho0 : 0;
  const Vec3 outward = actual / rho;
  const Vec3 around = axis.cross(outward);
  const double scale = k * rho0 * rho0 * taper;
  return {-scale * (G.slope * taper / rho * around + 2 * G.value * taper_slope * outward),
          scale * taper * G.value};
}

Vec3 across(const Vec3& axis, const Vec3& offset) { return offset - axis.dot(offset) * axis; }

Spring twist(const BoneSprings& springs, const BonePose& pose, const Carried& carried,
             const ParticleState& particle) {
  const Vec3 axis = pose.axis();
  const Vec3 actual = across(axis, particle.position - carried.foot);
  if (springs.twist_form == TwistForm::open_loop)
    return {springs.twist * pose.twist * axis.cross(actual), 0};
  return twist_servo(springs.twist, axis, across(axis, carried.target - carried.foot), actual,
                     particle.radius);
}

Spring axial(double k, const Vec3& axis, const Vec3& offset) {
  const double slide = axis.dot(offset);
  return {-k * slide * axis, k * slide * slide / 2};
}

BoneSprings springs_of(const BindingOptions& settings, const Material& material, double section,
                       const BoneStrength& strength) {
  const double unit =
      section > 0 ? material.young_modulus() * volume_per_particle(material.pair.r) / section : 0;
  BoneSprings bone;
  bone.radial = settings.stiffness * unit * strength.radial;
  bone.twist = settings.twist_stiffness * unit * strength.twist;
  bone.axial = settings.axial_stiffness * unit * strength.axial;
  bone.damping = 2 * settings.bone_damping * std::sqrt(bone.radial * material.mass);
  bone.form = settings.force;
  bone.twist_form = settings.twist_form;
  bone.max_force = settings.max_force.value_or(0);
  return bone;
}

}  // namespace

TwistEnergy twist_energy(double alpha) {
  const double angle = std::abs(alpha), linear = radians(120), fading = radians(60);
  if (angle <= linear) return {alpha * alpha / 2, alpha};
  const double t = std::min(1.0, (angle - linear) / fading);
  return {linear * linear / 2 + linear * fading * (t - t * t * t + t * t * t * t / 2),
          std::copysign(linear * (1 - t * t * (3 - 2 * t)), alpha)};
}

double BoneSprings::stiffest() const {
  return form == BoneForce::anchor ? radial : std::max({radial, twist, axial});
}

double BoneSprings::yield_energy() const {
  constexpr double twist_bound = 8 * pi * pi / 3;
  if (max_force <= 0) return 0;
  const double bound = form == BoneForce::anchor ? radial : radial + axial + twist_bound * twist;
  return bound > 0 ? max_force * max_force / (2 * bound) : 0;
}

Yielding yielding(double energy, double yield_energy) {
  if (yield_energy <= 0 || energy <= yield_energy) return {1, energy};
  return {std::sqrt(yield_energy / energy), 2 * std::sqrt(energy * yield_energy) - yield_energy};
}

std::vector<BoneSprings> bone_springs(const BindingOptions& settings, const Material& material,
                                      const Binding& binding) {
  std::vector<BoneSprings> springs;
  for (const double section : binding.cross_section)
    springs.push_back(springs_of(settings, material, section, {}));
  return springs;
}

std::vector<BoneSprings> bone_springs(const BindingOptions& settings, const Material& material,
                                      const Binding& binding, const Skeleton& skeleton) {
  std::vector<BoneSprings> springs;
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    const double section = binding.cross_section[b];
    const double softened = section * softening(settings, material, section, skeleton.bones[b]);
    springs.push_back(springs_of(settings, material, softened, skeleton.bones[b].strength));
  }
  return springs;
}

double softening(const BindingOptions& settings, const Material& material, double section,
                 const Bone& bone) {
  const double particles = section * bone.length / volume_per_particle(material.pair.r);
  return particles > 0 ? std::max(1.0, settings.soften_below / particles) : 1;
}

double stretch_lag(const Bone& bone, double radius) {
  return std::max(bone.length / 28, std::sqrt(2.0) * radius);
}

void hold_stretched(const Motion& motion, const Skeleton& skeleton, const Material& material,
                    std::vector<BoneSprings>& springs) {
  const double r = material.pair.r;
  for (const Track& track : motion.tracks) {
    if (!track.stretches()) continue;
    const auto b = static_cast<std::size_t>(track.bone);
    const double lag = stretch_lag(skeleton.bones[b], r);
    const double firm = material.young_modulus() * volume_per_particle(r) / (lag * lag);
    double& along = springs[b].form == BoneForce::anchor ? springs[b].radial : springs[b].axial;
    if (along > 0) along = std::max(along, firm);
  }
}

Vec3 carried_foot(const Influence& influence, const Bone& bone, const BonePose& pose) {
  return pose.frame.origin + pose.stretch * influence.foot * (pose.turn * bone.axis());
}

namespace {

void yield(const BoneSprings& springs, double weight, BonePull& pull, double& stretching) {
  if (weight <= 0) return;
  const auto [slope, energy] = yielding(pull.energy / weight, springs.yield_energy());
  for (Vec3* force : {&pull.spring, &pull.radial, &pull.twist, &pull.axial}) *force *= slope;
  stretching *= slope;
  pull.energy = weight * energy;
}

}  // namespace

BonePull bone_pull(const BoneSprings& springs, const Influence& influence, const Bone& bone,
                   const BonePose& pose, const ParticleState& particle) {
  const Carried carried = carry(influence, bone, pose, particle.rest);
  const double level = bone.axis().dot(particle.rest - bone.head());
  BonePull pull;
  double stretching = 0;  // N m: power that the springs take from the bone as it grows
  const auto add = [&](Vec3& part, const Spring& spring, double along) {
    part = influence.weight * spring.force;
    pull.spring += part;
    pull.energy += influence.weight * spring.energy;
    stretching += influence.weight * along * pose.axis().dot(spring.force);
  };
  const bool anchored = springs.form == BoneForce::anchor;
  if (anchored) {
    add(pull.radial, to_point(springs.radial, particle.position - carried.target), level);
  } else {
    add(pull.radial,
        radial(springs.radial, particle.position - carried.foot,
               influence.distance_to(bone, particle.rest), particle.radius),
        influence.foot);
    add(pull.twist, twist(springs, pose, carried, particle), 0);
    add(pull.axial, axial(springs.axial, pose.axis(), particle.position - carried.target), level);
  }
  if (springs.max_force > 0) yield(springs, influence.weight, pull, stretching);
  const Vec3 carried_by = pose.velocity_at(anchored ? carried.target : particle.position);
  pull.damping = -influence.weight * springs.damping * (particle.velocity - carried_by);
  const Vec3 bone_velocity = pose.velocity_at(particle.position);
  pull.power = pull.force().dot(bone_velocity);
  pull.damping_power = pull.damping.dot(bone_velocity);
  if (pose.stretch_rate != 0)  // springs are fixed at the foot at rest, not at the particle
    pull.power += pose.stretch_rate * stretching +
                  pull.spring.dot(pose.rigid_velocity_at(particle.position) - bone_velocity);
  return pull;
}

}  // namespace sinew
