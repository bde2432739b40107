// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/check/stiffness.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/material/elasticity.h>
#include <sinew/rig/motion.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

constexpr double largest_miss = 0.1;   // fraction of a modulus
constexpr std::size_t max_spans = 24;  // between grips: more say nothing more
constexpr double directed = 0.1;       // resultant of a load, over the sum of its forces' lengths
constexpr double smallest_motion = 1e-9;  // m, of a support against another

StiffnessAlong stiffness_along(const Body& body, const Vec3& direction, double section) {
  const Material& material = body.material;
  const bool isotropic = material.bond.second > 0;
  const double planes = std::sqrt(section) / half_plane_spacing(material.pair.r);
  return {material.constants().young_modulus(body.lattice.transpose() * direction), planes,
          lack_of_bending_stiffness(planes, isotropic),
          lack_of_pulled_stiffness(planes, isotropic)};
}

/// A support, or the resultant of a load.
struct Grip {
  std::string name;
  Vec3 center;
  Vec3 force = Vec3::Zero();         ///< force of a load, N
  const Support* support = nullptr;  ///< none: a load
  std::size_t number = 0;            ///< number of the support
  std::int32_t component = 0;        ///< component of the body
};

Vec3 resultant(const Load& load, const Points& rest) {
  if (load.stiffness > 0) return Vec3::Zero();
  LoadNow now(load);
  now.find(
      {}, [&](std::size_t k) { return rest[load.particles[k]]; }, false);
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < load.particles.size(); ++k) sum += now.force(k);
  return sum.norm() > directed * now.size() ? sum : Vec3::Zero();
}

Vec3 mean(const Points& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

/// The center of a support's particles.
Vec3 center_of(const Support& support, const Points& rest) {
  Points held;
  for (const std::uint32_t i : support.particles) held.push_back(rest[i]);
  return mean(held);
}

std::vector<Grip> grips_of(const Prepared& prepared) {
  const Points& rest = prepared.body.rest;
  const std::vector<std::int32_t>& component = prepared.filled.component;
  const auto component_of = [&](std::uint32_t particle) {
    return component.empty() ? 0 : component[particle];
  };
  std::vector<Grip> grips;
  for (std::size_t k = 0; k < prepared.body.world->supports.size(); ++k) {
    const Support& one = prepared.body.world->supports[k];
    grips.push_back({one.name, center_of(one, rest), Vec3::Zero(), &one, k,
                     component_of(one.particles.front())});
  }
  for (const Load& one : prepared.body.world->loads)
    if (const Vec3 force = resultant(one, rest); !force.isZero(0))
      grips.push_back(
          {one.name, one.pivot, force, nullptr, 0, component_of(one.particles.front())});
  if (const Vec3& gravity = prepared.settings.solver.gravity; !gravity.isZero(0))
    grips.push_back({"solver.gravity", mean(rest), gravity});
  return grips;
}

bool holds_along(const Support& support, const Vec3& direction) {
  if (!support.along.isZero(0)) return std::abs(support.along.dot(direction)) > 0.5;
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return support.holds[static_cast<std::size_t>(axis)];
}

enum class Strain { none, pulled, bent };

Strain strain_by(double along, double across) {
  if (std::max(along, across) <= 0) return Strain::none;
  return across > along ? Strain::bent : Strain::pulled;
}

/// How two supports strain what is between them by how they move from rest against each other.
Strain strain_between(const Prepared& prepared, const Grip& a, const Grip& b) {
  constexpr int moments = 8;
  const Body& body = prepared.body;
  const Vec3 from_a_to_b = b.center - a.center, axis = from_a_to_b.normalized();
  double along = smallest_motion, across = smallest_motion;
  for (int k = 0; k <= moments; ++k) {
    const double time = prepared.settings.solver.duration * k / moments;
    const auto now =
        poses_of(body.world->supports, time, pose_at(body.skeleton, prepared.motion, time));
    const auto frame = [&](const Grip& grip) { return now[grip.number].frame; };
    const auto place = [&](const Grip& grip) {
      return carried(grip.center, {grip.support->pivot, Mat3::Identity()}, frame(grip));
    };
    const Mat3 back = frame(a).rotation.transpose();
    const Vec3 moved = back * (place(b) - place(a)) - from_a_to_b;
    const Vec3 turned = rotation_vector(Quat(back * frame(b).rotation)) * from_a_to_b.norm();
    along = std::max(along, std::abs(moved.dot(axis)));
    across = std::max({across, moved.cross(axis).norm(), turned.cross(axis).norm()});
  }
  return strain_by(along - smallest_motion, across - smallest_motion);
}

Strain strain_of_span(const Prepared& prepared, const Grip& a, const Grip& b) {
  const Vec3 axis = (b.center - a.center).normalized();
  if (a.component != b.component) return Strain::none;
  if (a.support == nullptr && !prepared.body.world->supports.empty()) return Strain::none;
  if (b.support == nullptr)
    return strain_by(std::abs(b.force.dot(axis)), b.force.cross(axis).norm());
  if (!holds_along(*a.support, axis) || !holds_along(*b.support, axis)) return Strain::none;
  return strain_between(prepared, a, b);
}

/// Area across the body, as a mean over what is between two planes, m^2.
double section_between(const Body& body, const Vec3& from, const Vec3& to) {
  const double apart = (to - from).norm();
  const Vec3 axis = (to - from) / apart;
  const auto count = std::count_if(body.rest.begin(), body.rest.end(), [&](const Vec3& place) {
    const double at = axis.dot(place - from);
    return at > 0 && at <= apart;
  });
  return static_cast<double>(count) * volume_per_particle(body.material.pair.r) / apart;
}

std::string percent_text(double part) { return std::to_string(std::lround(100 * part)) + " %"; }

/// What is worst of `all`, with how many miss the modulus asked for, by what they show.
template <class One, class Shown>
struct Worst {
  const One* one = nullptr;
  std::size_t count = 0;

  Worst(const std::vector<One>& all, double asked, const Shown& shown) {
    const auto miss = [&](const One& any) { return std::abs(shown(any) / asked - 1); };
    for (const One& any : all) {
      count += miss(any) > largest_miss;
      if (one == nullptr || miss(any) > miss(*one)) one = &any;
    }
  }
};

/// "54 kPa, 46 % softer (70 kPa along it, less up to 23 % for 11 planes across); CURE".
std::string miss_text(const Body& body, const StiffnessAlong& worst, double lack) {
  const double asked = body.material.young_modulus(), shown = worst.young_modulus * (1 - lack);
  const bool isotropic = body.material.bond.second > 0;
  return quantity_text(shown, "Pa") + ", " + percent_text(std::abs(shown / asked - 1)) +
         (shown < asked ? " softer (" : " stiffer (") +
         parts_of_modulus(worst.young_modulus, lack, worst.planes) + "); make body.radius smaller" +
         (isotropic ? ""
                    : ", or use material.model bonded with fcc packing, which makes up for most");
}

}  // namespace

std::string parts_of_modulus(double along, double lack, double planes) {
  return quantity_text(along, "Pa") + " along it, less up to " + three_digits(100 * lack) +
         " % for " + three_digits(planes) + " planes across";
}

double lack_of_pulled_stiffness(double planes, bool isotropic) {
  return std::min(1.0, (isotropic ? 0.3 : 1.4) / planes);
}

std::vector<BoneStiffness> stiffness_along_bones(const Body& body) {
  std::vector<BoneStiffness> all;
  for (std::size_t b = 0; b < body.skeleton.size(); ++b) {
    const double section = body.binding.cross_section[b];
    if (!(section > 0)) continue;
    const Bone& bone = body.skeleton.bones[b];
    all.push_back({stiffness_along(body, bone.rest.rotation.col(0), section), bone.name});
  }
  return all;
}

std::vector<SpanStiffness> stiffness_between_grips(const Prepared& prepared) {
  const Body& body = prepared.body;
  std::vector<SpanStiffness> all;
  if (!body.world) return all;
  const double nearest = 2 * half_plane_spacing(body.material.pair.r);
  const std::vector<Grip> grips = grips_of(prepared);
  for (std::size_t b = 1; b < grips.size(); ++b)
    for (std::size_t a = 0; a < b && all.size() < max_spans; ++a) {
      const Vec3 apart = grips[b].center - grips[a].center;
      if (apart.norm() < nearest) continue;
      const Strain strain = strain_of_span(prepared, grips[a], grips[b]);
      const double section = section_between(body, grips[a].center, grips[b].center);
      if (strain == Strain::none || !(section > 0)) continue;
      all.push_back({stiffness_along(body, apart.normalized(), section), grips[a].name,
                     grips[b].name, strain == Strain::bent});
    }
  return all;
}

void warn_of_stiffness(const Prepared& prepared, std::vector<std::string>& warnings) {
  const Body& body = prepared.body;
  const double asked = body.material.young_modulus();
  const auto bent = [](const BoneStiffness& bone) { return bone.bending_modulus(); };
  const auto bones = stiffness_along_bones(body);
  if (const Worst worst(bones, asked, bent); worst.count > 0)
    warnings.push_back("bends along " + std::to_string(worst.count) + " of " +
                       std::to_string(bones.size()) + (bones.size() == 1 ? " bone" : " bones") +
                       " are over 10 % softer or stiffer than the modulus of " +
                       quantity_text(asked, "Pa") + "; most along '" + worst.one->bone +
                       "': " + miss_text(body, *worst.one, worst.one->lack));
  const auto shown = [](const SpanStiffness& span) { return span.shown_modulus(); };
  const auto spans = stiffness_between_grips(prepared);
  if (const Worst worst(spans, asked, shown); worst.count > 0)
    warnings.push_back(
        "the body " + std::string(worst.one->bends ? "bends" : "is pulled") + " between '" +
        worst.one->from + "' and '" + worst.one->to + "' with another modulus than the " +
        quantity_text(asked, "Pa") +
        " that were asked for: " + miss_text(body, *worst.one, worst.one->lack_shown()));
}

}  // namespace sinew
