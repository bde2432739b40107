// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/law_curves.h"

#include <algorithm>
#include <string>

#include "core/closest_packing.h"
#include "core/number_text.h"
#include "folder/measured_body.h"
#include "physics/bone_force.h"
#include "rig/binding.h"

namespace sinew {
namespace {

constexpr int samples = 300;

/// y at even steps of x, low and high included.
template <class Law>
CurveLine sampled(const char* name, double low, double high, const Law& law) {
  CurveLine line{name, {}, {}};
  for (int i = 0; i <= samples; ++i) {
    line.x.push_back(low + (high - low) * i / samples);
    line.y.push_back(law(line.x.back()));
  }
  return line;
}

std::string number(const char* name, double value, const char* unit) {
  return std::string(name) + " = " + three_digits(value) + ' ' + unit;
}

Curve pair_curve(const Material& material) {
  const PairForce pair = material.pair;
  Curve curve{
      "Force between two particles", "", "distance d in r", "f in N, repulsion positive", {}};
  curve.note = "f = k1 (4r² − d²) below 2r, −k2 (d − a)(b − d) from a to b, nothing beyond; " +
               number("k1", pair.k1, "Pa, ") + number("k2", pair.k2, "Pa, ") +
               number("a", pair.a / pair.r, "r, ") + number("b", pair.b / pair.r, "r.");
  if (material.model != MaterialModel::paper)
    curve.note += " Rest neighbours are held by bonds instead; others feel its repulsion.";
  curve.lines.push_back(sampled("force", 1.5, 1.15 * pair.b / pair.r,
                                [&](double d) { return pair.force(d * pair.r); }));
  if (material.model == MaterialModel::paper) return curve;
  const double stiffness = material.bond.stiffness;
  curve.lines.push_back(sampled("bond", 1.5, 1.15 * pair.b / pair.r,
                                [&](double d) { return -stiffness * (d - 2) * pair.r; }));
  return curve;
}

Curve energy_curve(const PairForce& pair) {
  Curve curve{"Energy of two particles", "", "distance d in r", "phi in J", {}};
  curve.note = "Its slope is the force; how deep it is says what it takes to part two particles.";
  curve.lines.push_back(sampled("energy", 1.5, 1.15 * pair.b / pair.r,
                                [&](double d) { return pair.potential(d * pair.r); }));
  return curve;
}

Curve bone_curve(const std::vector<BoneSprings>& springs, const Skeleton& skeleton, double r) {
  Curve curve{"Pull of a bone on a particle", "", "away from its place, in r", "force in N", {}};
  const bool anchored = springs.front().form == BoneForce::anchor;
  curve.note = anchored ? "f = −k_b (x − q), q the place the bone would carry the particle to."
                        : "Radial: f = −k_b (|x − p| − l0), p the nearest point of the bone.";
  constexpr std::size_t most_bones = 6;  // as many lines as can be told apart
  for (std::size_t b = 0; b < std::min(springs.size(), most_bones); ++b)
    curve.lines.push_back(sampled(skeleton.bones[b].name.c_str(), -2, 2,
                                  [&](double x) { return -springs[b].radial * x * r; }));
  return curve;
}

Curve twist_curve(const std::vector<BoneSprings>& springs, const Skeleton& skeleton, double r) {
  Curve curve{"Turning pull of a bone", "", "turned away by, degrees", "force in N", {}};
  curve.note = "f = −k_tau rho alpha for a particle at a distance rho = 5 r from the bone.";
  constexpr std::size_t most_bones = 6;
  for (std::size_t b = 0; b < std::min(springs.size(), most_bones); ++b)
    curve.lines.push_back(sampled(skeleton.bones[b].name.c_str(), -90, 90, [&](double angle) {
      return -springs[b].twist * 5 * r * radians(angle);
    }));
  return curve;
}

}  // namespace

std::vector<Curve> law_curves(const RunFiles& run) {
  const Material material = material_of(run);
  std::vector<Curve> curves{pair_curve(material)};
  if (material.model == MaterialModel::paper) curves.push_back(energy_curve(material.pair));
  if (run.skeleton.size() == 0) return curves;
  const double r = run.body.particles.radius;
  const Binding binding = bind_to_bones(positions_of(run.body.particles), run.skeleton,
                                        volume_per_particle(r), run.settings.binding.joint_zone);
  const std::vector<BoneSprings> springs = bone_springs(run.settings.binding, material, binding);
  curves.push_back(bone_curve(springs, run.skeleton, r));
  if (springs.front().form == BoneForce::paper && springs.front().twist_form == TwistForm::servo)
    curves.push_back(twist_curve(springs, run.skeleton, r));
  return curves;
}

}  // namespace sinew
