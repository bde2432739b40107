// SPDX-License-Identifier: GPL-3.0-or-later
// The binding in the kernel's layout: for each block the bones to which it is bound, with the
// coordinates of its particles in each bone's frame side by side.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/core/lines.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/block_state.h>

namespace sinew {

template <class Real>
struct BoneSlots {
  std::vector<std::uint32_t> first;  ///< blocks + 1 long
  std::vector<kernel::Slot> slots;
  Lines<Real> attachments, weights;

  /// Origin of each bone's frame, m from the head along the axis: the mean of the particles
  /// bound to it, so that few digits are lost far from a head.
  std::vector<double> center;
};

/// `id`: the particles in the kernel's order.
template <class Real>
BoneSlots<Real> bone_slots(const Body& body, std::span<const std::int32_t> id, const Units& units);

/// The bones at `pose` in the kernel's layout, for particles of `mass` (kg).
template <class Real>
std::vector<kernel::BoneNow<Real>> bones_now(const Body& body, const Pose& pose,
                                             std::span<const double> center, double mass,
                                             const Units& units);

/// A rigid frame whose center is the point that is at `center` (m) now.
template <class Real>
kernel::FrameNow<Real> frame_now(const BonePose& pose, const Vec3& center, const Units& units);

}  // namespace sinew
