// SPDX-License-Identifier: GPL-3.0-or-later
// Which bones pull each particle, with what weight, and from where: determined once, at rest.
//
//     const Binding binding = bind_to_bones(rest, skeleton, options);
//     for (const Influence& influence : binding.of(i)) use(influence.bone, influence.weight);
//
// A particle belongs to the bone whose segment is nearest (Komiya and Tokoi), by straight distance
// or inside the body (inside_distance.h), or to the bones that given weights name. In a joint zone
// it belongs to all bones that meet there, with weights that change smoothly from one to the other
// (joint_zones.h): without a zone, a twist falls between two lattice planes and cuts the body.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <sinew/core/cell_grid.h>
#include <sinew/rig/skeleton.h>

namespace sinew {

/// The influence of one bone on one particle.
struct Influence {
  int bone = no_bone;
  double weight = 0;  ///< the weights of a particle sum to 1
  double foot = 0;    ///< reference point on the bone's axis: m from the head towards the tail

  /// In the rest pose.
  Vec3 foot_on(const Bone& its_bone) const { return its_bone.head() + foot * its_bone.axis(); }
  /// Returns the distance from the foot to a particle at rest, m.
  double distance_to(const Bone& its_bone, const Vec3& rest) const {
    return (rest - foot_on(its_bone)).norm();
  }
};

struct Binding {
  std::vector<std::uint32_t> first;   ///< n + 1 long; particle i has [first[i], first[i + 1])
  std::vector<Influence> influences;  ///< the heaviest of a particle comes first
  std::vector<double> cross_section;  ///< per bone: volume bound to it over its length, m^2
  /// Particles that no path inside the body connects to a bone: bound to the nearest.
  std::size_t unreached = 0;

  std::span<const Influence> of(std::size_t i) const {
    return {influences.data() + first[i], first[i + 1] - first[i]};
  }
  /// The bone with the largest weight for particle i; no_bone for a particle without bones.
  int bone(std::size_t i) const {
    return first[i] == first[i + 1] ? no_bone : influences[first[i]].bone;
  }
  /// The weight of that bone; 0 without one.
  double weight(std::size_t i) const {
    return first[i] == first[i + 1] ? 0 : influences[first[i]].weight;
  }
};

/// Particles that belong to one bone, or to none, whatever is nearest: those with the given
/// numbers, and those in the box or the ball.
struct BoundRegion {
  int bone = no_bone;
  std::vector<std::uint32_t> ids;  ///< ascending
  std::optional<Box> box;          ///< m, its border included
  Vec3 center = Vec3::Zero();      ///< center of the ball, m
  double radius = -1;              ///< radius of the ball, m; below 0: no ball

  bool holds(std::size_t particle, const Vec3& rest) const;
};

struct BindOptions {
  double radius = 0;  ///< radius of the particles, m; their volume is that of closest packing
  /// Nearest neighbors of the particles at rest, by which paths inside go; nullptr: searched.
  const NeighborLists* neighbors = nullptr;
  bool inside = false;    ///< nearest by the path inside the body
  double joint_zone = 0;  ///< length of the zones in square roots of the bones' cross-section
  /// Particles farther away have no bone, m.
  double core_radius = std::numeric_limits<double>::infinity();
  /// Override all else; of several that contain a particle the last one applies.
  std::vector<BoundRegion> regions = {};
  /// Per particle: used instead of the nearest bone. A particle without weights gets the nearest.
  std::optional<BoneWeights> weights = {};
};

/// Binds particles at `rest` (n x 3, m). In parallel, except for the paths inside.
Binding bind_to_bones(const Points& rest, const Skeleton& skeleton, const BindOptions& options);

/// To the nearest segment, for particles of volume `particle_volume` (m^3).
Binding bind_to_bones(const Points& rest, const Skeleton& skeleton, double particle_volume,
                      double joint_zone);

/// Index of the bone whose segment is nearest to `point`; the lower index on ties.
int nearest_bone(const Skeleton& skeleton, const Vec3& point);

/// Returns the distance from a point to a bone's segment, m.
double distance_to(const Bone& bone, const Vec3& point);

}  // namespace sinew
