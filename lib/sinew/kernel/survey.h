// SPDX-License-Identifier: GPL-3.0-or-later
// Surveys particles: how they move and how far they extend.
#pragma once

#include <sinew/kernel/vectors.h>

namespace sinew::kernel {

/// What Survey sums up, by place in the block, whatever the width.
template <class L>
struct SurveySums {
  static constexpr int block = Traits<typename L::Real>::block;
  using Row = typename L::Real[block];
  Row low[3] = {}, high[3] = {}, low_along[3] = {}, high_along[3] = {};
  Row x[3] = {}, v[3] = {}, xx[6] = {}, xv[3] = {};

  static SINEW_INLINE void bound(Row& low, Row& high, int lane, typename L::V value) {
    L::store(low + lane, L::smaller(value, L::load(low + lane)));
    L::store(high + lane, L::larger(value, L::load(high + lane)));
  }

  SINEW_INLINE void add(int lane, const Triple<L>& at, const Triple<L>& velocity,
                        const typename L::Real (&axes)[3][3]) {
    const Triple<L> moment = cross<L>(at, velocity);
    const typename L::V xs[3] = {at.x, at.y, at.z}, vs[3] = {velocity.x, velocity.y, velocity.z},
                        ms[3] = {moment.x, moment.y, moment.z};
    for (int k = 0; k < 3; ++k) {
      bound(low[k], high[k], lane, xs[k]);
      bound(low_along[k], high_along[k], lane, dot<L>(all<L>(axes[k]), at));
      add_to<L>(x[k] + lane, xs[k]);
      add_to<L>(v[k] + lane, vs[k]);
      add_to<L>(xv[k] + lane, ms[k]);
      add_to<L>(xx[k] + lane, xs[k] * xs[k]);
      add_to<L>(xx[3 + k] + lane, xs[(k + 1) % 3] * xs[(k + 2) % 3]);
    }
  }

  static void over_lanes(const Row& low, const Row& high, double& least, double& most) {
    least = most = 0;
    for (int lane = 0; lane < block; ++lane) {
      const auto one = static_cast<double>(low[lane]), other = static_cast<double>(high[lane]);
      least = one < least ? one : least;
      most = other > most ? other : most;
    }
  }

  Survey over_lanes() const {
    Survey all;
    for (int k = 0; k < 3; ++k) {
      over_lanes(low[k], high[k], all.low[k], all.high[k]);
      over_lanes(low_along[k], high_along[k], all.low_along[k], all.high_along[k]);
      all.x[k] = sum_of<L>(x[k]);
      all.v[k] = sum_of<L>(v[k]);
      all.xv[k] = sum_of<L>(xv[k]);
      all.xx[k] = sum_of<L>(xx[k]);
      all.xx[3 + k] = sum_of<L>(xx[3 + k]);
    }
    return all;
  }
};

template <class L>
Survey survey(const SurveyInput<typename L::Real>& input, const typename L::Coord* center) {
  constexpr std::size_t size = Traits<typename L::Real>::block;
  const Place<L> middle{L::all_coord(center[0]), L::all_coord(center[1]), L::all_coord(center[2])};
  SurveySums<L> sums;
  for (std::size_t first = input.begin / size * size; first < input.end; first += L::width) {
    typename L::Real live[L::width];
    for (std::size_t k = 0; k < L::width; ++k)
      live[k] = first + k >= input.begin && first + k < input.end ? typename L::Real(1)
                                                                  : typename L::Real(0);
    const auto i = static_cast<std::ptrdiff_t>(first);
    sums.add(static_cast<int>(first % size),
             L::load(live) * offset<L>(load_place<L>(input.state.x, i), middle),
             L::load(live) * load<L>(input.state.v, i), input.axes);
  }
  return sums.over_lanes();
}

}  // namespace sinew::kernel
