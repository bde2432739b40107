// SPDX-License-Identifier: GPL-3.0-or-later
// Small things that the parts of the kernel share: three vectors, masks, frames of bones.
#pragma once

#include "physics/kernel/kernel.h"
#include "physics/kernel/lanes.h"

#define SINEW_INLINE inline __attribute__((always_inline))

namespace sinew::kernel {

template <class L>
struct Triple {
  typename L::V x, y, z;
};

template <class L>
SINEW_INLINE Triple<L> operator+(const Triple<L>& a, const Triple<L>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class L>
SINEW_INLINE Triple<L> operator-(const Triple<L>& a, const Triple<L>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class L>
SINEW_INLINE Triple<L> operator*(typename L::V s, const Triple<L>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

/// c + s a.
template <class L>
SINEW_INLINE Triple<L> fused(typename L::V s, const Triple<L>& a, const Triple<L>& c) {
  return {L::fused(s, a.x, c.x), L::fused(s, a.y, c.y), L::fused(s, a.z, c.z)};
}

template <class L>
SINEW_INLINE typename L::V dot(const Triple<L>& a, const Triple<L>& b) {
  return L::fused(a.x, b.x, L::fused(a.y, b.y, a.z * b.z));
}

/// Rounded as everywhere outside of the kernel: what decides about a pair is the same there.
template <class L>
SINEW_INLINE typename L::V squared_distance(const Triple<L>& a) {
  return a.x * a.x + (a.y * a.y + a.z * a.z);
}

template <class L>
SINEW_INLINE Triple<L> none() {
  return {L::all(0), L::all(0), L::all(0)};
}

template <class L>
SINEW_INLINE Triple<L> load(const typename L::Real* const p[3], std::ptrdiff_t i) {
  return {L::load(p[0] + i), L::load(p[1] + i), L::load(p[2] + i)};
}

template <class L>
SINEW_INLINE void store(typename L::Real* const p[3], std::ptrdiff_t i, const Triple<L>& a) {
  L::store(p[0] + i, a.x);
  L::store(p[1] + i, a.y);
  L::store(p[2] + i, a.z);
}

template <class L>
SINEW_INLINE Triple<L> all(const typename L::Real v[3]) {
  return {L::all(v[0]), L::all(v[1]), L::all(v[2])};
}

/// Coordinates of a vector's particles.
template <class L>
struct Place {
  typename L::C x, y, z;
};

template <class L>
SINEW_INLINE Place<L> load_place(typename L::Coord* const p[3], std::ptrdiff_t i) {
  return {L::load_coord(p[0] + i), L::load_coord(p[1] + i), L::load_coord(p[2] + i)};
}

template <class L>
SINEW_INLINE Triple<L> offset(const Place<L>& a, const Place<L>& b) {
  return {L::difference(a.x, b.x), L::difference(a.y, b.y), L::difference(a.z, b.z)};
}

/// From a frame's centre to the particles, in the directions of the scene.
template <class L>
SINEW_INLINE Triple<L> from_centre(const FrameNow<typename L::Real>& frame, const Place<L>& at) {
  const Place<L> centre{L::all_coord(frame.centre[0]), L::all_coord(frame.centre[1]),
                        L::all_coord(frame.centre[2])};
  return offset<L>(at, centre) - all<L>(frame.rest_of_centre);
}

/// The coordinates in a frame of a vector in the scene.
template <class L>
SINEW_INLINE Triple<L> into_frame(const FrameNow<typename L::Real>& frame, const Triple<L>& a) {
  return {dot<L>(all<L>(frame.axes), a), dot<L>(all<L>(frame.axes + 3), a),
          dot<L>(all<L>(frame.axes + 6), a)};
}

/// And back.
template <class L>
SINEW_INLINE Triple<L> from_frame(const FrameNow<typename L::Real>& frame, const Triple<L>& a) {
  return fused<L>(a.x, all<L>(frame.axes),
                  fused<L>(a.y, all<L>(frame.axes + 3), a.z * all<L>(frame.axes + 6)));
}

template <class L>
SINEW_INLINE Triple<L> cross(const Triple<L>& a, const Triple<L>& b) {
  return {L::less_fused(a.z, b.y, a.y * b.z), L::less_fused(a.x, b.z, a.z * b.x),
          L::less_fused(a.y, b.x, a.x * b.y)};
}

/// Weights and leads of a slot's lanes; a bone alone on its block has all of both.
template <class L>
struct Shares {
  typename L::V weight, lead;
};

template <class L>
SINEW_INLINE Shares<L> shares_of(const Holds<typename L::Real>& holds, const Slot& slot, int lane) {
  constexpr int block = Traits<typename L::Real>::block;
  if (slot.shares < 0) return {L::all(1), L::all(1)};
  const auto* fields =
      holds.shares + static_cast<std::ptrdiff_t>(slot.shares) * share_fields * block + lane;
  return {L::load(fields + weight * block), L::load(fields + lead * block)};
}

/// The velocity, at a distance from its centre, of what a frame carries.
template <class L>
SINEW_INLINE Triple<L> carried_by(const FrameNow<typename L::Real>& frame, const Triple<L>& arm) {
  return all<L>(frame.velocity) + cross<L>(all<L>(frame.spin), arm);
}

/// For each lane what `told` says of the frame that carries it.
template <class L, class Tell>
SINEW_INLINE Triple<L> by_carrier(const Carriers<typename L::Real>& carriers, std::size_t block,
                                  int lane, Tell tell) {
  constexpr int size = Traits<typename L::Real>::block;
  const std::uint32_t begin = carriers.first[block], end = carriers.first[block + 1];
  if (end - begin == 1 && carriers.slots[begin].lanes < 0) [[likely]]
    return tell(carriers.frames[carriers.slots[begin].frame]);
  Triple<L> sum = none<L>();
  for (std::uint32_t s = begin; s != end; ++s) {
    const CarrierSlot slot = carriers.slots[s];
    const auto* lanes = carriers.lanes + static_cast<std::ptrdiff_t>(slot.lanes) * size + lane;
    sum = sum + L::load(lanes) * tell(carriers.frames[slot.frame]);
  }
  return sum;
}

}  // namespace sinew::kernel
