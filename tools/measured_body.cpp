// SPDX-License-Identifier: GPL-3.0-or-later
#include "measured_body.h"

namespace sinew {

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

}  // namespace sinew
