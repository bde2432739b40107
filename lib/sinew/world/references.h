// SPDX-License-Identifier: GPL-3.0-or-later
// What parts of a body move with, for damping relative to it: bones whose springs pull, pins and
// supports, or where these leave rigid motions free, the part's own.
//
//     RigidDamping damping = rigid_damping_of(body, rate);
//     std::vector<AffineMotion> now = motions_of_holders(damping, body, time, pose);
#pragma once

#include <sinew/body/body.h>
#include <sinew/body/rigid_damping.h>
#include <sinew/world/world.h>

namespace sinew {

/// Finds the references of each part that hangs together at rest. Several that hold a part share
/// its particles by weights: those of the binding where bones pull, 1 where pins and supports hold,
/// harmonic over the neighbors at rest elsewhere.
RigidDamping rigid_damping_of(const Body& body, double rate);

/// The same after bonds have broken: `piece` labels, by id, what still hangs together. What holds
/// nothing of a piece is no reference of it.
RigidDamping cut(const RigidDamping& whole, const Body& body, std::span<const std::uint32_t> piece);

/// The motion of each reference at a moment; of parts that move by themselves, none.
std::vector<AffineMotion> motions_of_holders(const RigidDamping& damping, const Body& body,
                                             double time, const Pose& pose);

/// Rigid motions of a part about `center` (m): columns of displacements and rotations (rad), that
/// its pins and supports at these places (m, by the reference's pins) take from it least;
/// orthonormal with rotations at `arm` (m).
Eigen::Matrix<double, 6, Eigen::Dynamic> free_motions(const Reference& part, const World* world,
                                                      std::span<const Vec3> places,
                                                      const Vec3& center, double arm);

/// Adds the force on a particle at `p` (N) to what bones and supports answer for: on the body, of
/// supports about their pivots; of the body on bones, about their heads.
void add_reactions(const RigidDamping& damping, std::size_t particle, const Vec3& p,
                   const Vec3& force, std::span<const AffineMotion> motions,
                   std::span<Reaction> on_bones, std::span<Reaction> of_supports);

}  // namespace sinew
