// SPDX-License-Identifier: GPL-3.0-or-later
// What all of the kernel works with: 3-vectors over lanes, masks, rigid frames, the arctangent.
#pragma once

#include <sinew/kernel/kernel.h>
#include <sinew/kernel/lanes.h>

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

/// Rounded as outside the kernel: both select the same pairs.
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

/// Coordinates of a vector of particles.
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

/// Returns vectors from a frame's center to the particles, in scene coordinates.
template <class L>
SINEW_INLINE Triple<L> from_center(const FrameNow<typename L::Real>& frame, const Place<L>& at) {
  const Place<L> center{L::all_coord(frame.center[0]), L::all_coord(frame.center[1]),
                        L::all_coord(frame.center[2])};
  return offset<L>(at, center) - all<L>(frame.rest_of_center);
}

/// Components of a scene vector in a frame.
template <class L>
SINEW_INLINE Triple<L> into_frame(const FrameNow<typename L::Real>& frame, const Triple<L>& a) {
  return {dot<L>(all<L>(frame.axes), a), dot<L>(all<L>(frame.axes + 3), a),
          dot<L>(all<L>(frame.axes + 6), a)};
}

/// The reverse.
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

/// Weights and leads of a slot's lanes; a bone alone on its block has both equal to 1.
template <class L>
struct Weights {
  typename L::V weight, lead;
};

template <class L>
SINEW_INLINE Weights<L> weights_of(const Bindings<typename L::Real>& bindings, const Slot& slot,
                                   int lane) {
  constexpr int block = Traits<typename L::Real>::block;
  if (slot.weights < 0) return {L::all(1), L::all(1)};
  const auto* fields =
      bindings.weights + static_cast<std::ptrdiff_t>(slot.weights) * weight_fields * block + lane;
  return {L::load(fields + weight * block), L::load(fields + lead * block)};
}

/// Velocity of a point of the frame at `arm` from its center.
template <class L>
SINEW_INLINE Triple<L> carried_by(const FrameNow<typename L::Real>& frame, const Triple<L>& arm) {
  return all<L>(frame.velocity) + cross<L>(all<L>(frame.spin), arm);
}

/// Adds to sums by place in the block.
template <class L>
SINEW_INLINE void add_to(typename L::Real* sum, typename L::V value) {
  L::store(sum, L::load(sum) + value);
}

/// Over the places in the block, in their order.
template <class L>
SINEW_INLINE double sum_of(const typename L::Real* by_lane) {
  double sum = 0;
  for (int k = 0; k < Traits<typename L::Real>::block; ++k) sum += static_cast<double>(by_lane[k]);
  return sum;
}

/// 1 in lanes with a particle, 0 in those with padding.
template <class L>
SINEW_INLINE typename L::V live_lanes(std::size_t blocks, const typename L::Real* live,
                                      std::size_t block, int lane) {
  return block + 1 == blocks ? L::load(live + lane) : L::all(1);
}

}  // namespace sinew::kernel

// The angle from (1, 0) to (x, y), in every lane.

namespace sinew::kernel {

// atan t = t + t^3 q(t^2) for |t| <= tan(pi / 8): q by a Chebyshev fit, with an error of atan t / t
// below 6e-18 (double) and 3e-9 (float).
template <class L>
SINEW_INLINE typename L::V short_arctangent(typename L::V t) {
  using V = typename L::V;
  using Real = typename L::Real;
  const auto all = [](double c) { return L::all(static_cast<Real>(c)); };
  const V s = t * t, s2 = s * s;
  // In pairs of terms that do not depend on each other.
  const auto two = [&](double c0, double c1) { return L::fused(all(c1), s, all(c0)); };
  if constexpr (sizeof(Real) == 4) {
    const V low = two(-0.33333331761161, 0.19999540481962);
    const V high = L::fused(all(-0.06451926114690), s2, two(-0.14263955539545, 0.10743730859150));
    return L::fused(t * s, L::fused(s2, high, low), t);
  } else {
    const V s4 = s2 * s2;
    const V low = L::fused(s2, two(-0.14285714284666534304, 0.11111111015255668508),
                           two(-0.3333333333333333016, 0.19999999999995520637));
    const V middle = L::fused(s2, two(-0.066645114381646448357, 0.058581488327312729465),
                              two(-0.090909045780957349208, 0.076921831901717284121));
    const V high = L::fused(s2, all(-0.019176872294336066637),
                            two(-0.050854493189300349167, 0.039231646190551487845));
    return L::fused(t * s, L::fused(s4, L::fused(s4, high, middle), low), t);
  }
}

/// In (-pi, pi]; not a number for (0, 0).
template <class L>
SINEW_INLINE typename L::V arctangent(typename L::V y, typename L::V x) {
  using V = typename L::V;
  using Real = typename L::Real;
  constexpr Real pi = static_cast<Real>(3.14159265358979323846);
  const V steep = L::all(static_cast<Real>(0.41421356237309504880));  // tan(pi / 8)
  const V rise = L::size(y), run = L::size(x);
  if (L::every(L::at_most(rise, steep * x))) return short_arctangent<L>(y / x);
  const auto low = L::at_most(rise, steep * run), high = L::at_most(run, steep * rise);
  const V over = L::pick(low, rise, L::pick(high, L::all(0) - run, rise - run));
  const V under = L::pick(low, run, L::pick(high, rise, rise + run));
  const V turned = L::pick(low, L::all(0), L::pick(high, L::all(pi / 2), L::all(pi / 4)));
  const V angle = turned + short_arctangent<L>(over / under);
  const V all_round = L::pick(L::less(x, L::all(0)), L::all(pi) - angle, angle);
  return L::pick(L::less(y, L::all(0)), L::all(0) - all_round, all_round);
}

}  // namespace sinew::kernel
