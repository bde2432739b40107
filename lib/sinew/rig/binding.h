// SPDX-License-Identifier: GPL-3.0-or-later
// Which bones pull each particle, with what weight, and from where: fixed once, in the rest pose.
//
// A particle belongs to the bone whose segment is nearest (Komiya and Tokoi), through the air or
// inside the body (inside_distance.h), or to the bones that given weights name. Within a joint zone
// it belongs to all bones that meet there, with weights that pass smoothly from one to the other
// (joint_zones.h): without a zone a twist falls between two lattice planes and cuts the body.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <sinew/rig/skeleton.h>
#include <sinew/rig/skinning.h>

namespace sinew {

/// One bone's hold on one particle.
struct Influence {
  int bone = no_bone;
  double weight = 0;  ///< the weights of a particle sum to 1
  double foot = 0;    ///< reference point on the bone's axis: m from the head towards the tail
  double rest_distance = 0;  ///< from the foot to the particle at rest, m

  /// In the rest pose.
  Vec3 foot_on(const Bone& its_bone) const { return its_bone.head() + foot * its_bone.axis(); }
};

struct Binding {
  std::vector<std::uint32_t> first;   ///< n + 1 long; particle i has [first[i], first[i + 1])
  std::vector<Influence> influences;  ///< the heaviest of a particle comes first
  std::vector<double> cross_section;  ///< per bone: volume bound to it over its length, m^2
  std::size_t unreached = 0;  ///< particles no bone reaches inside the body: bound to the nearest

  std::span<const Influence> of(std::size_t i) const {
    return {influences.data() + first[i], first[i + 1] - first[i]};
  }
  /// The bone that holds particle i most; no_bone where none does.
  int bone(std::size_t i) const {
    return first[i] == first[i + 1] ? no_bone : influences[first[i]].bone;
  }
  /// Of that bone; 0 where none holds it.
  double weight(std::size_t i) const {
    return first[i] == first[i + 1] ? 0 : influences[first[i]].weight;
  }
};

/// Particles that belong to one bone, or to none, whatever is near: those of the numbers, and those
/// in the box and the ball.
struct BoundRegion {
  int bone = no_bone;
  std::vector<std::uint32_t> ids;  ///< ascending
  std::optional<Box> box;          ///< m, its border included
  Vec3 center = Vec3::Zero();      ///< of the ball, m
  double radius = -1;              ///< of the ball, m; below 0: no ball

  bool holds(std::size_t particle, const Vec3& rest) const;
};

struct BindOptions {
  double radius = 0;      ///< of the particles, m; their volume is that of closest packing
  bool inside = false;    ///< nearest by the way inside the body
  double joint_zone = 0;  ///< length of the zones in square roots of the bones' cross-section
  double core_radius = std::numeric_limits<double>::infinity();  ///< farther ones have no bone, m
  std::vector<BoundRegion> regions = {};  ///< over all else; the last that holds a particle counts
  /// Per particle: these instead of the nearest bone. A particle without any has the nearest.
  std::optional<BoneWeights> weights = {};
};

/// Binds particles at `rest` (n x 3, m). In parallel, the ways inside excepted.
Binding bind_to_bones(const Points& rest, const Skeleton& skeleton, const BindOptions& options);

/// By the nearest segment, for particles of the volume `particle_volume` (m^3).
Binding bind_to_bones(const Points& rest, const Skeleton& skeleton, double particle_volume,
                      double joint_zone);

/// Index of the bone whose segment is nearest to `point`; the lower index on ties.
int nearest_bone(const Skeleton& skeleton, const Vec3& point);

/// From a point to a bone's segment, m.
double distance_to(const Bone& bone, const Vec3& point);

}  // namespace sinew
