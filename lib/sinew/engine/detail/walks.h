// SPDX-License-Identifier: GPL-3.0-or-later
// The members of what an engine is told, for archive.h.
#pragma once

#include <sinew/engine/detail/archive.h>
#include <sinew/engine/detail/world_walks.h>
#include <sinew/engine/engine_files.h>

namespace sinew {

template <class Transfer>
void walk(RigidFrame& frame, Transfer& transfer) {
  transfer(frame.origin);
  transfer(frame.rotation);
}

template <class Transfer>
void walk(Bone& bone, Transfer& transfer) {
  transfer(bone.name);
  transfer(bone.parent);
  transfer(bone.length);
  transfer(bone.rest);
  transfer(bone.limits.swing);
  transfer(bone.limits.min_twist);
  transfer(bone.limits.max_twist);
  for (double* factor : {&bone.strength.radial, &bone.strength.twist, &bone.strength.axial})
    transfer(*factor);
}

template <class Value, class Transfer>
void walk(Curve<Value>& curve, Transfer& transfer) {
  transfer(curve.interpolation);
  transfer(curve.times);
  for (auto* values : {&curve.values, &curve.in, &curve.out}) transfer(*values);
  transfer(curve.cyclic);
}

template <class Transfer>
void walk(RotationCurve& curve, Transfer& transfer) {
  transfer(curve.interpolation);
  transfer(curve.times);
  transfer(curve.turns);
  for (auto* values : {&curve.values, &curve.in, &curve.out}) transfer(*values);
  transfer(curve.cyclic);
}

template <class Transfer>
void walk(Track& track, Transfer& transfer) {
  transfer(track.bone);
  transfer(track.rotation);
  transfer(track.twist);
  transfer(track.translation);
  transfer(track.stretch);
}

template <class Transfer>
void walk(Motion& motion, Transfer& transfer) {
  transfer(motion.tracks);
  transfer(motion.extrapolation);
  transfer(motion.start);
  transfer(motion.end);
  transfer(motion.speed);
  transfer(motion.preroll);
}

template <class Transfer>
void walk(BoneSprings& springs, Transfer& transfer) {
  for (double* value : {&springs.radial, &springs.twist, &springs.axial, &springs.damping})
    transfer(*value);
  transfer(springs.form);
  transfer(springs.twist_form);
}

template <class Transfer>
void walk(Material& material, Transfer& transfer) {
  transfer(material.model);
  transfer(material.cohesion);
  PairForce& pair = material.pair;
  for (double* value : {&pair.r, &pair.k1, &pair.k2, &pair.a, &pair.b}) transfer(*value);
  BondStrength& bond = material.bond;
  for (double* value :
       {&bond.stiffness, &bond.second, &bond.breaking_strain, &bond.yield_shear, &bond.creep_rate})
    transfer(*value);
  for (double* value : {&material.relaxed, &material.volume_stiffness, &material.order,
                        &material.mass, &material.damping})
    transfer(*value);
  transfer(material.damping_form);
}

template <class Transfer>
void walk(Stepping& stepping, Transfer& transfer) {
  transfer(stepping.integrator);
  transfer(stepping.step);
  transfer(stepping.gravity);
  transfer(stepping.precision);
  transfer(stepping.neighbor_search);
}

template <class Transfer>
void walk(LedgerEntries& ledger, Transfer& transfer) {
  transfer(ledger.work);
  transfer(ledger.dissipation);
  transfer(ledger.power);
  transfer(ledger.begun);
}

template <class Transfer>
void walk(EnginePieces& pieces, Transfer& transfer) {
  transfer(pieces.folder);
  transfer(pieces.encoding);
  transfer(pieces.double_precision);
  transfer(pieces.arrays);
  transfer(pieces.every);
}

template <class Transfer>
void walk(EngineMoment& moment, Transfer& transfer) {
  transfer(moment.steps);
  transfer(moment.kicked);
  transfer(moment.ledger);
  transfer(moment.world_ledger);
  transfer(moment.held_at_start);
  transfer(moment.particles);
  transfer(moment.in_frame);
  transfer(moment.engine);
}

template <class Transfer>
void walk(WholeSteps& steps, Transfer& transfer) {
  transfer(steps.count);
  transfer(steps.step);
}

template <class Transfer>
void walk(EngineSetup& setup, Transfer& transfer) {
  transfer(setup.particles);
  for (std::int32_t* width : {&setup.shape.bones, &setup.shape.nearest, &setup.shape.second})
    transfer(*width);
  transfer(setup.material);
  transfer(setup.skeleton.bones);
  transfer(setup.motion);
  transfer(setup.springs);
  transfer(setup.stepping);
  transfer(setup.steps_per_frame);
  transfer(setup.frames);
  transfer(setup.parts);
  transfer(setup.last);
  transfer(setup.start);
  transfer(setup.with_forces);
  transfer(setup.pieces);
  transfer(setup.world);
}

}  // namespace sinew
