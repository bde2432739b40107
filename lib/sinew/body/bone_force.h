// SPDX-License-Identifier: GPL-3.0-or-later
// How a bone pulls a particle bound to it (Komiya and Tokoi, made well-posed): a radial spring that
// keeps its distance from the bone, a twist spring that rotates it with the bone, an axial spring
// against sliding along the bone, and damping of the motion relative to the bone.
//
//     const BonePull pull = bone_pull(springs[b], influence, bone, pose[b], particle);
//     force += pull.force();
#pragma once

#include <vector>

#include <sinew/core/options.h>
#include <sinew/material/material.h>
#include <sinew/rig/binding.h>
#include <sinew/rig/motion.h>
#include <sinew/rig/pose.h>

namespace sinew {

/// Spring constants of one bone on each of its particles.
struct BoneSprings {
  double radial = 0;   ///< or of the anchor, N/m
  double twist = 0;    ///< N/m: the moment is twist rho0^2 alpha
  double axial = 0;    ///< N/m
  double damping = 0;  ///< kg/s
  BoneForce form = BoneForce::paper;
  TwistForm twist_form = TwistForm::servo;
  double max_force = 0;  ///< limit of all three on a particle, N: see yielding(); 0: none

  double stiffest() const;      ///< N/m
  double yield_energy() const;  ///< J; 0: they never yield
};

/// Springs that yield: of energy U0 up to Y, then of 2 sqrt(U0 Y) - Y, whose slope in U0 is
/// sqrt(Y / U0). With Y = F^2 / (2 K) their force is at most F, since that of U0 is at most
/// sqrt(2 K U0): the square of each spring's own is at most 2 k U, that of the twist's, near the
/// axis and at half a turn, 8 pi^2 / 3 times as much, and K is the sum of all (Cauchy-Schwarz).
struct Yielding {
  double slope;   ///< factor on the force
  double energy;  ///< J
};
Yielding yielding(double energy, double yield_energy);

/// The springs of every bone: stiffness E V0 / A of a bone's cross-section A, so that strengths
/// keep their meaning when radius, size or modulus change. Damping is 2 zeta sqrt(radial mass).
std::vector<BoneSprings> bone_springs(const BindingOptions& settings, const Material& material,
                                      const Binding& binding);

/// The same, multiplied by each bone's own factors.
std::vector<BoneSprings> bone_springs(const BindingOptions& settings, const Material& material,
                                      const Binding& binding, const Skeleton& skeleton);

/// The factor, 1 or more, by which binding.soften_below softens the springs of a bone with that
/// cross-section (m^2) of particles.
double softening(const BindingOptions& settings, const Material& material, double section,
                 const Bone& bone);

/// Raises the axial springs of bones whose length the motion changes (of anchors all springs), so
/// that the flesh follows: unless they are 0. A bar of modulus E whose particles are held along it
/// by springs k lags behind over sqrt(E V0 / k) from each end; that is at most stretch_lag() then.
void hold_stretched(const Motion& motion, const Skeleton& skeleton, const Material& material,
                    std::vector<BoneSprings>& springs);

/// Length of flesh that stays behind at each end of a bone that stretches, m: 1/28 of the bone, and
/// no less than a layer of particles, below which springs would shorten the step.
double stretch_lag(const Bone& bone, double radius);

/// How the twist spring's energy rises with the angle (rad) from where the bone has turned a
/// particle to where it is: G = alpha^2 / 2 up to 120 degrees; beyond, its slope falls smoothly to
/// zero at half a turn, where the direction of the shorter way changes.
struct TwistEnergy {
  double value;  ///< G
  double slope;  ///< dG / dalpha
};
TwistEnergy twist_energy(double alpha);

/// The force of one bone on one particle.
struct BonePull {
  Vec3 spring = Vec3::Zero();   ///< radial + twist + axial, N
  Vec3 radial = Vec3::Zero();   ///< N; of an anchor its whole spring
  Vec3 twist = Vec3::Zero();    ///< N
  Vec3 axial = Vec3::Zero();    ///< N
  Vec3 damping = Vec3::Zero();  ///< N
  double energy = 0;            ///< stored in the springs, J; 0 for open_loop's twist
  double power = 0;             ///< power from the bone: force times the bone's velocity there, W
  double damping_power = 0;     ///< the damping's part of power, W

  Vec3 force() const { return spring + damping; }
};

/// A particle at rest and at present.
struct ParticleState {
  Vec3 rest, position, velocity;  ///< m, m, m/s
  double radius;                  ///< m
  std::size_t id = 0;             ///< in the written order
};

/// Where the bone at `pose` has moved the influence's reference point, m.
Vec3 carried_foot(const Influence& influence, const Bone& bone, const BonePose& pose);

/// The pull, including the weight, of the bone at `pose` (at rest `bone`) through `influence`.
BonePull bone_pull(const BoneSprings& springs, const Influence& influence, const Bone& bone,
                   const BonePose& pose, const ParticleState& particle);

}  // namespace sinew
