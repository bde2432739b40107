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

template <class L>
SINEW_INLINE typename L::V dot(const Triple<L>& a, const Triple<L>& b) {
  return a.x * b.x + (a.y * b.y + a.z * b.z);
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
SINEW_INLINE Triple<L> offset(const Place<L>& a, const Place<L>& b, typename L::V unit) {
  return {L::difference(a.x, b.x, unit), L::difference(a.y, b.y, unit),
          L::difference(a.z, b.z, unit)};
}

/// From a bone's centre to the particles, in the directions of the scene.
template <class L>
SINEW_INLINE Triple<L> from_centre(const BoneNow<typename L::Real>& bone, const Place<L>& at,
                                   typename L::V unit) {
  const Place<L> centre{L::all_coord(bone.centre[0]), L::all_coord(bone.centre[1]),
                        L::all_coord(bone.centre[2])};
  return offset<L>(at, centre, unit) - all<L>(bone.rest_of_centre);
}

/// The coordinates in the bone's frame of a vector in the scene.
template <class L>
SINEW_INLINE Triple<L> into_frame(const BoneNow<typename L::Real>& bone, const Triple<L>& a) {
  return {dot<L>(all<L>(bone.axes), a), dot<L>(all<L>(bone.axes + 3), a),
          dot<L>(all<L>(bone.axes + 6), a)};
}

/// And back.
template <class L>
SINEW_INLINE Triple<L> from_frame(const BoneNow<typename L::Real>& bone, const Triple<L>& a) {
  return a.x * all<L>(bone.axes) + (a.y * all<L>(bone.axes + 3) + a.z * all<L>(bone.axes + 6));
}

template <class L>
SINEW_INLINE Triple<L> cross(const Triple<L>& a, const Triple<L>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
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

}  // namespace sinew::kernel
