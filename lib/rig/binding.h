// SPDX-License-Identifier: GPL-3.0-or-later
// Which bones pull each particle, with what weight, and from where: fixed once, in the rest pose.
//
// A particle belongs to the bone whose segment is nearest (Komiya and Tokoi). Within a joint zone
// it belongs to both bones that meet there, with weights that pass linearly from one to the other
// along the joint's axis: without a zone a twist falls between two lattice planes and cuts the
// body.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rig/skeleton.h"

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

  std::span<const Influence> of(std::size_t i) const {
    return {influences.data() + first[i], first[i + 1] - first[i]};
  }
  /// The bone that holds particle i most; no_bone where none does.
  int bone(std::size_t i) const {
    return first[i] == first[i + 1] ? no_bone : influences[first[i]].bone;
  }
};

/// Binds particles at `rest` (n x 3, m), each of volume `particle_volume` (m^3), to the bones.
/// In parallel; `joint_zone` is the length of the zone in square roots of the bones' cross-section;
/// 0: none.
Binding bind_to_bones(const Points& rest, const Skeleton& skeleton, double particle_volume,
                      double joint_zone);

/// Index of the bone whose segment is nearest to `point`; the lower index on ties.
int nearest_bone(const Skeleton& skeleton, const Vec3& point);

}  // namespace sinew
