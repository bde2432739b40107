// SPDX-License-Identifier: GPL-3.0-or-later
// The members of what engines read, for archive.h.
#pragma once

#include <sinew/core/archive.h>
#include <sinew/engine/detail/serialize_world.h>
#include <sinew/engine/engine_files.h>

namespace sinew {

template <class Archive>
void serialize(Archive& archive, RigidFrame& frame) {
  archive(frame.origin);
  archive(frame.rotation);
}

template <class Archive>
void serialize(Archive& archive, Bone& bone) {
  archive(bone.name);
  archive(bone.parent);
  archive(bone.length);
  archive(bone.rest);
  archive(bone.limits.swing);
  archive(bone.limits.min_twist);
  archive(bone.limits.max_twist);
  for (double* factor : {&bone.strength.radial, &bone.strength.twist, &bone.strength.axial})
    archive(*factor);
}

template <class Value, class Archive>
void serialize(Archive& archive, Curve<Value>& curve) {
  archive(curve.interpolation);
  archive(curve.times);
  for (auto* values : {&curve.values, &curve.in, &curve.out}) archive(*values);
  archive(curve.cyclic);
}

template <class Archive>
void serialize(Archive& archive, RotationCurve& curve) {
  archive(curve.interpolation);
  archive(curve.times);
  archive(curve.turns);
  for (auto* values : {&curve.values, &curve.in, &curve.out}) archive(*values);
  archive(curve.cyclic);
}

template <class Archive>
void serialize(Archive& archive, Track& track) {
  archive(track.bone);
  archive(track.rotation);
  archive(track.twist);
  archive(track.translation);
  archive(track.stretch);
}

template <class Archive>
void serialize(Archive& archive, Motion& motion) {
  archive(motion.tracks);
  archive(motion.extrapolation);
  archive(motion.start);
  archive(motion.end);
  archive(motion.speed);
  archive(motion.preroll);
}

template <class Archive>
void serialize(Archive& archive, BoneSprings& springs) {
  for (double* value : {&springs.radial, &springs.twist, &springs.axial, &springs.damping})
    archive(*value);
  archive(springs.form);
  archive(springs.twist_form);
}

template <class Archive>
void serialize(Archive& archive, Material& material) {
  archive(material.model);
  archive(material.cohesion);
  PairForce& pair = material.pair;
  for (double* value : {&pair.r, &pair.k1, &pair.k2, &pair.a, &pair.b}) archive(*value);
  BondStrength& bond = material.bond;
  for (double* value :
       {&bond.stiffness, &bond.second, &bond.breaking_strain, &bond.yield_shear, &bond.creep_rate})
    archive(*value);
  for (double* value : {&material.relaxed, &material.volume_stiffness, &material.order,
                        &material.mass, &material.damping})
    archive(*value);
  archive(material.damping_form);
}

template <class Archive>
void serialize(Archive& archive, Stepping& stepping) {
  archive(stepping.integrator);
  archive(stepping.step);
  archive(stepping.gravity);
  archive(stepping.precision);
  archive(stepping.neighbor_search);
}

template <class Archive>
void serialize(Archive& archive, EnginePieces& pieces) {
  archive(pieces.folder);
  archive(pieces.encoding);
  archive(pieces.double_precision);
  archive(pieces.arrays);
  archive(pieces.every);
}

template <class Archive>
void serialize(Archive& archive, EngineMoment& moment) {
  archive(moment.steps);
  archive(moment.kicked);
  archive(moment.ledgers);
  archive(moment.particles);
  archive(moment.in_frame);
  archive(moment.engine);
}

template <class Archive>
void serialize(Archive& archive, WholeSteps& steps) {
  archive(steps.count);
  archive(steps.step);
}

template <class Archive>
void serialize(Archive& archive, EngineSetup& setup) {
  archive(setup.particles);
  for (std::int32_t* width : {&setup.shape.bones, &setup.shape.nearest, &setup.shape.second})
    archive(*width);
  archive(setup.material);
  archive(setup.skeleton.bones);
  archive(setup.motion);
  archive(setup.springs);
  archive(setup.stepping);
  archive(setup.steps_per_frame);
  archive(setup.frames);
  archive(setup.parts);
  archive(setup.last);
  archive(setup.start);
  archive(setup.with_forces);
  archive(setup.pieces);
  archive(setup.world);
}

}  // namespace sinew
