// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/rigid_slots.h>

#include <algorithm>
#include <cmath>

namespace sinew {
namespace {

/// Nearest place that the kernel's coordinates can tell; returns it in m.
Vec3 put_center(const Vec3& p, const Units& units, double* center) {
  for (int axis = 0; axis < 3; ++axis) center[axis] = p[axis] - units.origin[axis];
  return p;
}

Vec3 put_center(const Vec3& p, const Units& units, std::int32_t* center) {
  Vec3 put;
  for (int axis = 0; axis < 3; ++axis) {
    const double whole = std::nearbyint((p[axis] - units.origin[axis]) / units.length);
    center[axis] = static_cast<std::int32_t>(static_cast<std::int64_t>(whole));
    put[axis] = units.origin[axis] + units.length * whole;
  }
  return put;
}

}  // namespace

template <class Real>
RigidSlots<Real> rigid_slots(const RigidDamping& damping, std::span<const std::int32_t> id) {
  constexpr std::size_t block = kernel::Traits<Real>::block;
  RigidSlots<Real> all;
  all.first.push_back(0);
  std::size_t weighted = 0;
  for (std::size_t begin = 0; begin < id.size(); begin += block) {
    const auto ids = id.subspan(begin, std::min(block, id.size() - begin));
    const std::size_t first = all.slots.size();
    const auto slot_of = [&](std::uint32_t reference) {
      const auto same = [&](const kernel::Slot& slot) {
        return slot.bone == static_cast<std::int32_t>(reference);
      };
      const auto from = all.slots.begin() + static_cast<std::ptrdiff_t>(first);
      return static_cast<std::size_t>(std::find_if(from, all.slots.end(), same) -
                                      all.slots.begin());
    };
    bool one = ids.size() == block;  // padding moves with nothing
    for (const std::int32_t i : ids)
      for (const Share& share : damping.of(static_cast<std::size_t>(i))) {
        one = one && share.weight == 1;
        if (slot_of(share.reference) == all.slots.size())
          all.slots.push_back({static_cast<std::int32_t>(share.reference), -1});
      }
    for (const std::int32_t i : ids)
      one = one && damping.of(static_cast<std::size_t>(i)).size() == all.slots.size() - first;
    all.first.push_back(static_cast<std::uint32_t>(all.slots.size()));
    if (one) continue;
    const std::size_t row = weighted;
    weighted += all.slots.size() - first;
    all.weights.resize(weighted * block);
    for (std::size_t s = first; s < all.slots.size(); ++s)
      all.slots[s].weights = static_cast<std::int32_t>(row + s - first);
    for (std::size_t lane = 0; lane < ids.size(); ++lane)
      for (const Share& share : damping.of(static_cast<std::size_t>(ids[lane])))
        all.weights[(row + slot_of(share.reference) - first) * block + lane] =
            static_cast<Real>(share.weight);
  }
  return all;
}

template <class Real>
kernel::AffineMotion<Real> motion_now(const AffineMotion& motion, Reference::Kind kind,
                                      const Units& units) {
  kernel::AffineMotion<Real> now{};
  const Vec3 velocity = motion.velocity_at(put_center(motion.at, units, now.center));
  for (int row = 0; row < 3; ++row) {
    now.velocity[row] = static_cast<Real>(units.velocity(velocity[row]));
    for (int column = 0; column < 3; ++column)
      now.gradient[3 * row + column] = static_cast<Real>(motion.gradient(row, column) * units.time);
  }
  now.of_bones = kind == Reference::bone ? Real(1) : Real(0);
  return now;
}

template RigidSlots<double> rigid_slots(const RigidDamping&, std::span<const std::int32_t>);
template RigidSlots<float> rigid_slots(const RigidDamping&, std::span<const std::int32_t>);
template kernel::AffineMotion<double> motion_now(const AffineMotion&, Reference::Kind,
                                                 const Units&);
template kernel::AffineMotion<float> motion_now(const AffineMotion&, Reference::Kind, const Units&);

}  // namespace sinew
