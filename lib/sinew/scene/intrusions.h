// SPDX-License-Identifier: GPL-3.0-or-later
// Flesh that a motion drives into other flesh, found beforehand: the particles skinned by dual
// quaternions into the pose of each moment, those of one bone inside those of another.
//
//     for (const Intrusion& one : intrusions(body, motion, times)) print(one.depth);
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/rig/motion.h>

namespace sinew {

/// Two bones whose flesh overlaps.
struct Intrusion {
  std::array<int, 2> bones = {no_bone, no_bone};  ///< the lower one first
  double depth = 0;               ///< largest depth of one's flesh in the other's, m
  double first = 0, deepest = 0;  ///< moments of the first overlap and of that, s
};

/// Depth in radii from which flesh passes through flesh where that is to be found.
inline constexpr double passing_depth = 1.5;

/// Finds overlaps of half a radius and more at `times` (s, ascending), the deepest first. What is
/// near at rest counts not, nor do folds at joints: where bones have particles that touch at rest,
/// flesh within the width of the limb around these. In parallel.
std::vector<Intrusion> intrusions(const Body& body, const Motion& motion,
                                  std::span<const double> times);

/// The particles of two bones that overlap at `pose`, ascending.
std::vector<std::uint32_t> overlapping(const Body& body, const Pose& pose,
                                       const std::array<int, 2>& bones);

/// The particles of the body at `pose`, by id, m: by dual quaternions, with the weights of its
/// binding. Those without a bone stay.
Points skinned(const Body& body, const Pose& pose);

/// "'hand' and 'thigh' (3.2 r), ...": the deepest of them, and how many more.
std::string intrusions_text(std::span<const Intrusion> found, const Body& body);

}  // namespace sinew
