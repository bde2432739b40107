// SPDX-License-Identifier: GPL-3.0-or-later
// Sums up mass, moments and momenta of particles, in double precision whatever they are kept in.
#pragma once

#include <sinew/kernel/vectors.h>

namespace sinew::kernel {

/// Sums by place in eight, whatever the width.
template <class L>
struct MomentaSums {
  using Row = double[8];
  Row sum[momenta] = {};

  SINEW_INLINE void add(int lane, typename L::V mass, const Triple<L>& at,
                        const Triple<L>& velocity) {
    const typename L::V xs[3] = {at.x, at.y, at.z};
    const Triple<L> p = mass * velocity, turning = cross<L>(at, p);
    const typename L::V ps[3] = {p.x, p.y, p.z}, ls[3] = {turning.x, turning.y, turning.z};
    add_to<L>(sum[0] + lane, mass);
    for (int k = 0; k < 3; ++k) {
      const typename L::V moment = mass * xs[(k + 1) % 3];
      add_to<L>(sum[1 + k] + lane, mass * xs[k]);
      add_to<L>(sum[4 + k] + lane, mass * xs[k] * xs[k]);
      add_to<L>(sum[7 + k] + lane, moment * xs[(k + 2) % 3]);
      add_to<L>(sum[10 + k] + lane, ps[k]);
      add_to<L>(sum[13 + k] + lane, ls[k]);
    }
  }
};

/// Eight particles from the k-th on; beyond the end they have no mass.
template <class Real>
struct EightParticles {
  double x[3][8], v[3][8], mass[8];

  SINEW_INLINE EightParticles(const MomentaInput<Real>& input, std::size_t k) {
    const std::size_t left = input.end - k;
    if (left >= 8)
      read(input, k, 8);
    else
      read(input, k, static_cast<int>(left));
  }

 private:
  SINEW_INLINE void read(const MomentaInput<Real>& input, std::size_t k, int count) {
    for (int axis = 0; axis < 3; ++axis)
      for (int lane = 0; lane < 8; ++lane) {
        const std::size_t i = k + static_cast<std::size_t>(lane < count ? lane : 0);
        x[axis][lane] =
            static_cast<double>(input.state.x[axis][i]) * input.length + input.shift[axis];
        v[axis][lane] = static_cast<double>(input.state.v[axis][i]) * input.speed;
      }
    for (int lane = 0; lane < 8; ++lane)
      mass[lane] = lane >= count           ? 0
                   : input.mass == nullptr ? 1
                                           : input.mass[k + static_cast<std::size_t>(lane)];
  }
};

template <class L, class Real>
void sum_momenta(const MomentaInput<Real>& input, double* out) {
  MomentaSums<L> sums;
  for (std::size_t k = input.begin; k < input.end; k += 8) {
    const EightParticles<Real> eight(input, k);
    for (int lane = 0; lane < 8; lane += L::width) {
      const auto of = [&](const double(&rows)[3][8]) {
        return Triple<L>{L::load(rows[0] + lane), L::load(rows[1] + lane), L::load(rows[2] + lane)};
      };
      sums.add(lane, L::load(eight.mass + lane), of(eight.x), of(eight.v));
    }
  }
  for (int n = 0; n < momenta; ++n) out[n] = sum_of<L>(sums.sum[n]);
}

}  // namespace sinew::kernel
