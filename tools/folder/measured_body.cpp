// SPDX-License-Identifier: GPL-3.0-or-later
#include "folder/measured_body.h"

#include <utility>

namespace sinew {

Material material_of(const RunFiles& run) {
  return make_material(run.settings.material,
                       shape_of(positions_of(run.body.particles), run.body.particles.radius,
                                run.body.particles.mass));
}

PairLaw pair_law(const Material& material) {
  const PairForce pair = material.pair;
  const auto all = [pair](double d) { return pair.force(d); };
  const auto repulsion = [pair](double d) { return d < 2 * pair.r ? pair.force(d) : 0; };
  if (material.model == MaterialModel::paper) {
    if (material.cohesion == Cohesion::all) return {all, {}, 0};
    return {repulsion, [pair](double d, double) { return pair.force(d); }, 0};
  }
  if (material.bond.breaking_strain > 0 || material.bond.yield_strain > 0) return {};
  const double k = material.bond.stiffness;
  return {repulsion, [k](double d, double rest) { return -k * (d - rest); },
          material.volume_stiffness};
}

RestInput measured_body(const Material& material, const Skeleton& skeleton) {
  RestInput input;
  for (const Bone& bone : skeleton.bones)
    input.bones.push_back({bone.name, bone.parent, bone.length, bone.rest});
  input.radius = material.pair.r;
  input.interaction_range = material.pair.b;
  input.mass = material.mass;
  input.law = pair_law(material);
  return input;
}

RestInput measured_body(const RunFiles& run) {
  RestInput input = measured_body(material_of(run), run.skeleton);
  input.positions = positions_of(run.body.particles);
  input.surface = run.surface;
  input.bone.assign(run.body.bone->begin(), run.body.bone->end());
  if (run.body.weight) input.weight = *run.body.weight;
  return input;
}

FrameState measured_frame(RunFrame frame) {
  return {frame.time,
          std::move(frame.positions),
          std::move(frame.velocities),
          std::move(frame.surface_points),
          std::move(frame.bones),
          frame.energies,
          std::move(frame.bone_lengths),
          std::move(frame.broken_bonds)};
}

}  // namespace sinew
