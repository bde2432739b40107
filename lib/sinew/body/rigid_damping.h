// SPDX-License-Identifier: GPL-3.0-or-later
// Damping -alpha m (v - v_ref) of each particle relative to what holds the body there: Rayleigh's
// mass-proportional part, which takes no shorter steps. v_ref is a mean of motions that are affine
// in place, of bones and supports, by weights made once at rest; and what a part of the body can do
// as a rigid body is not damped.
//
//     body.rigid_damping = std::make_shared<const RigidDamping>(rigid_damping_of(body, rate));
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

/// v(p) = velocity + gradient (p - at).
struct AffineMotion {
  Vec3 at = Vec3::Zero();        ///< m
  Vec3 velocity = Vec3::Zero();  ///< there, m/s
  Mat3 gradient = Mat3::Zero();  ///< 1/s

  Vec3 velocity_at(const Vec3& p) const { return velocity + gradient * (p - at); }
};

/// What a part of the body moves with: a bone, a support, the scene, or itself.
struct Reference {
  enum Kind : std::int32_t { scene, bone, support, itself };

  Kind kind = scene;
  std::int32_t which = 0;  ///< bone or support
  /// Number of rigid motions that nothing takes from a part that moves by itself, 1 to 6.
  int freedom = 0;
  std::vector<std::uint32_t> pins = {};  ///< pins of the world on that part
};

struct Share {
  std::uint32_t reference = 0;
  double weight = 0;
};

struct RigidDamping {
  double rate = 0;  ///< alpha, 1/s
  std::vector<Reference> references;
  // Shares of particle i (by id): [first[i], first[i + 1]). Those of bones, supports and the scene
  // sum to 1, or there are none; the motion of its part by itself, if there is one, comes last,
  // with weight 1.
  std::vector<std::uint32_t> first;
  std::vector<Share> shares;

  std::span<const Share> of(std::size_t i) const {
    return {shares.data() + first[i], first[i + 1] - first[i]};
  }
  /// Sums the motions (one for each reference) of particle i at a place.
  Vec3 velocity_at(std::size_t i, const Vec3& p, std::span<const AffineMotion> motions) const {
    Vec3 sum = Vec3::Zero();
    for (const Share& share : of(i)) sum += share.weight * motions[share.reference].velocity_at(p);
    return sum;
  }
};

}  // namespace sinew
