// SPDX-License-Identifier: GPL-3.0-or-later
// What blocks of particles are damped relative to (body/rigid_damping.h), in the kernel's layout.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/body/rigid_damping.h>
#include <sinew/core/lines.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/block_state.h>

namespace sinew {

template <class Real>
struct RigidSlots {
  std::vector<std::uint32_t> first;  ///< blocks + 1 long
  std::vector<kernel::Slot> slots;
  Lines<Real> weights;
};

/// `id`: the particles in the kernel's order.
template <class Real>
RigidSlots<Real> rigid_slots(const RigidDamping& damping, std::span<const std::int32_t> id);

/// The motion of one reference in the kernel's layout.
template <class Real>
kernel::AffineMotion<Real> motion_now(const AffineMotion& motion, Reference::Kind kind,
                                      const Units& units);

}  // namespace sinew
