// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/rest_body.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include <sinew/core/error.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/material/laws.h>

namespace sinew {
namespace {

constexpr std::size_t particles_at_a_time = 1024;
const char* const cure = "measure a run that sinew has written";

void require(bool holds, const std::string& what) {
  if (!holds) throw bad_input(what, cure);
}

void check_bones(const std::vector<Bone>& bones) {
  for (std::size_t i = 0; i < bones.size(); ++i) {
    const Bone& bone = bones[i];
    require(bone.parent >= -1 && bone.parent < static_cast<int>(i),
            "the parent of bone '" + bone.name + "' is not an earlier bone");
    require(std::isfinite(bone.length) && bone.length > 0,
            "bone '" + bone.name + "' has no length");
    require(bone.rest.origin.allFinite() && bone.rest.rotation.allFinite(),
            "bone '" + bone.name + "' has a rest frame that is not finite");
  }
}

void check_surface(const Triangles& surface) {
  require(all_finite(surface.points), "the surface at rest has a point that is not finite");
  const int points = static_cast<int>(surface.points.size());
  for (const auto& face : surface.faces)
    for (const int corner : face)
      require(corner >= 0 && corner < points,
              "a triangle of the surface refers to a missing point");
}

void check(const RestInput& input) {
  require(!input.positions.empty(), "the body has no particles");
  require(all_finite(input.positions), "the body has a particle at a position that is not finite");
  require(std::isfinite(input.material.pair.r) && input.material.pair.r > 0,
          "the particle radius is not above 0");
  require(std::isfinite(input.material.pair.b) && input.material.pair.b > 0,
          "the interaction range is not above 0");
  require(input.bone.size() == input.positions.size(),
          "there are " + std::to_string(input.positions.size()) + " particles but bones for " +
              std::to_string(input.bone.size()));
  require(input.weight.empty() || input.weight.size() == input.positions.size(),
          "there are " + std::to_string(input.positions.size()) + " particles but weights for " +
              std::to_string(input.weight.size()));
  check_bones(input.skeleton.bones);
  for (const int bone : input.bone)
    require(bone >= -1 && bone < static_cast<int>(input.skeleton.bones.size()),
            "a particle follows bone " + std::to_string(bone) + ", which does not exist");
  check_surface(input.surface);
}

Vec3 nearest_on(const Bone& bone, const Vec3& point) {
  const double at = bone.axis().dot(point - bone.rest.origin);
  return bone.rest.origin + std::clamp(at, 0.0, bone.length) * bone.axis();
}

/// Half the width of the body around each bone, m.
std::vector<double> half_widths(const RestInput& input) {
  std::vector<double> followers(input.skeleton.bones.size());
  for (const int bone : input.bone)
    if (bone >= 0) ++followers[bone];
  for (std::size_t i = 0; i < followers.size(); ++i)
    followers[i] = std::sqrt(followers[i] * volume_per_particle(input.material.pair.r) /
                             input.skeleton.bones[i].length) /
                   2;
  return followers;
}

struct JointZone {
  Vec3 center;
  double reach;  ///< m
};

std::vector<JointZone> joint_zones(const RestInput& input) {
  const std::vector<double> half = half_widths(input);
  std::vector<JointZone> zones;
  for (std::size_t i = 0; i < input.skeleton.bones.size(); ++i)
    if (const int parent = input.skeleton.bones[i].parent; parent >= 0)
      zones.push_back({input.skeleton.bones[i].rest.origin, std::max(half[i], half[parent])});
  return zones;
}

bool near_joint(const std::vector<JointZone>& zones, const Vec3& place) {
  return std::any_of(zones.begin(), zones.end(), [&](const JointZone& zone) {
    return (place - zone.center).norm() <= zone.reach;
  });
}

std::vector<Bound> bound_particles(const RestInput& input, const std::vector<JointZone>& zones) {
  std::vector<Bound> all;
  for (std::size_t i = 0; i < input.bone.size(); ++i) {
    if (input.bone[i] < 0) continue;
    Bound bound{static_cast<std::uint32_t>(i), input.bone[i]};
    bound.foot = nearest_on(input.skeleton.bones[bound.bone], input.positions[i]);
    bound.distance = (input.positions[i] - bound.foot).norm();
    // Tests the foot, not the particle: the zone is a slab across the bones, including corners.
    bound.far = !near_joint(zones, bound.foot);
    all.push_back(bound);
  }
  return all;
}

}  // namespace

bool all_finite(const Points& points) {
  return std::all_of(points.begin(), points.end(), [](const Vec3& p) { return p.allFinite(); });
}

namespace {

/// value(i, j) of each bond, by entry of the neighbors, then of second ones.
template <class Value>
std::vector<double> by_bond(const RestBody& body, const Value& value) {
  std::vector<double> values(body.shape.neighbors.neighbor.size() + body.second.neighbor.size());
  double* first = values.data();
  for (const NeighborLists* lists : {&body.shape.neighbors, &body.second}) {
    parallel_for(lists->size(), particles_at_a_time, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (std::uint32_t e = lists->first[i]; e < lists->first[i + 1]; ++e)
          first[e] = value(static_cast<std::uint32_t>(i), lists->neighbor[e]);
    });
    first += lists->neighbor.size();
  }
  return values;
}

/// Sums k l^2 over a particle's bonds, over that of one inside, as if all were of one material.
std::vector<double> volume_shares_by_stiffness(const RestBody& body,
                                               const std::vector<double>& factors) {
  const double k = body.material.bond.stiffness, second = body.material.bond.second;
  if (factors.empty() || second == 0) return {};
  const double r = body.radius();
  const double inside = 12 * k * 4 * r * r + 6 * second * 8 * r * r;
  const std::vector<double>& modulus = body.forces.stiffness;
  const auto modulus_between = [&](std::size_t i, std::size_t j) {  // modulus of springs in series
    return modulus.empty() ? 1 : 2 / (1 / modulus[i] + 1 / modulus[j]);
  };
  std::vector<double> volume_shares(body.particles(), 0);
  const double* factor = factors.data();
  const auto add = [&](const NeighborLists& lists, double stiffness) {
    for (std::size_t i = 0; i < lists.size(); ++i)
      for (const std::uint32_t j : lists.of(i))
        volume_shares[i] += *factor++ / modulus_between(i, j) * stiffness / inside *
                            (body.shape.points[i] - body.shape.points[j]).squaredNorm();
  };
  add(body.shape.neighbors, k);
  add(body.second, second);
  return volume_shares;
}

}  // namespace

std::vector<double> first_bond_rest(const RestBody& rest) {
  return by_bond(rest, [&](std::uint32_t i, std::uint32_t j) {
    return (rest.shape.points[i] - rest.shape.points[j]).norm();
  });
}

struct RestBody::Found {
  std::once_flag once;
  SharedNeighbors neighbors;  ///< until the stiffness is found
  BondStiffness stiffness;
};

const BondStiffness& RestBody::stiffness() const {
  std::call_once(stiffness_->once, [this] {
    BondStiffness& found = stiffness_->stiffness;
    if (forces.known) {
      const auto factors =
          forces.factors ? forces.factors
                         : std::make_shared<const BondFactors>(bond_factors(
                               shape.points, *stiffness_->neighbors, material, forces.volume_share,
                               forces.stiffness, forces.volume_stiffness));
      found.volume_weight = factors->volume_weight;
      if (material.bond.second > 0)  // else all are 1
        found.factor =
            by_bond(*this, [&](std::uint32_t i, std::uint32_t j) { return factors->of(i).at(j); });
    }
    stiffness_->neighbors.reset();
    const bool keeps_volume =
        forces.known && (material.volume_stiffness > 0 || !forces.volume_stiffness.empty());
    require(!keeps_volume || found.volume_weight.size() == particles(),
            "there are " + std::to_string(particles()) + " particles that keep their volumes, " +
                "but weights for " + std::to_string(found.volume_weight.size()));
    if (law_of(material).has_memory && !bonds_change(material))
      found.length = first_bond_rest(*this);
    found.volume_share = volume_shares_by_stiffness(*this, found.factor);
  });
  return stiffness_->stiffness;
}

namespace {

bool is_outermost(const RestShape& shape, double radius, std::size_t i) {
  constexpr double equal = 1e-3, one_sided = 0.2;
  const auto neighbors = shape.neighbors.of(i);
  bool in_lattice = true;
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t j : neighbors) {
    const Vec3 to = shape.points[j] - shape.points[i];
    in_lattice = in_lattice && std::abs(to.norm() - 2 * radius) < 2 * equal * radius;
    sum += to.normalized();
  }
  if (in_lattice) return neighbors.size() < max_neighbors_at_rest;
  return sum.norm() > one_sided * static_cast<double>(neighbors.size());
}

}  // namespace

std::vector<std::int32_t> surface_layers(const RestShape& shape, double radius) {
  std::vector<std::int32_t> layer(shape.points.size(), 0);
  for (std::size_t i = 0; i < layer.size(); ++i) layer[i] = is_outermost(shape, radius, i) ? 1 : 0;
  for (std::size_t i = 0; i < layer.size(); ++i)
    if (layer[i] == 1)
      for (const std::uint32_t j : shape.neighbors.of(i))
        if (layer[j] == 0) layer[j] = 2;
  return layer;
}

Triangles measured_surface(const RestBody& rest, const FrameState& state) {
  if (rest.fine) return {rest.fine->at(state.positions), rest.fine->rest.faces};
  return {state.surface_points, rest.surface.faces};
}

RestBody rest_body(RestInput input) {
  check(input);
  RestBody body;
  body.volume = volume(input.surface);
  body.area = area(input.surface);
  require(body.area > 0, "the surface at rest has no area");
  const std::vector<JointZone> zones = joint_zones(input);
  body.bound = bound_particles(input, zones);
  body.sections = make_sections(input.fine ? input.fine->rest : input.surface, input.skeleton.bones,
                                [&](const Vec3& place) { return near_joint(zones, place); });
  body.slices =
      make_slices(input.positions, input.bone, input.skeleton.bones, input.material.pair.r);
  const bool with_second = input.material.bond.second > 0;
  if (!input.neighbors)
    input.neighbors = std::make_shared<const RestNeighbors>(
        rest_neighbors(input.positions, input.material.pair.r, with_second));
  body.shape = rest_shape(std::move(input.positions), input.neighbors->nearest);
  body.layer =
      input.layer.empty() ? surface_layers(body.shape, input.material.pair.r) : input.layer;
  if (with_second) body.second = second_neighbors(*input.neighbors);
  body.bone_of = std::move(input.bone);
  body.weight = std::move(input.weight);
  body.surface = std::move(input.surface);
  body.fine = std::move(input.fine);
  body.bones = std::move(input.skeleton.bones);
  body.start = input.start;
  body.material = input.material;
  body.forces = std::move(input.forces);
  body.stiffness_ = std::make_shared<RestBody::Found>();
  body.stiffness_->neighbors = std::move(input.neighbors);
  body.density = std::move(input.density);
  return body;
}

}  // namespace sinew
