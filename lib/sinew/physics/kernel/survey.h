// SPDX-License-Identifier: GPL-3.0-or-later
// Surveys a piece: how it moves and how large it is.
#pragma once

#include <sinew/physics/kernel/parts.h>

namespace sinew::kernel {

/// What Survey sums up, by place in the block, whatever the width.
template <class L>
struct SurveySums {
  static constexpr int block = Traits<typename L::Real>::block;
  typename L::Real low[3][block] = {}, high[3][block] = {}, x[3][block] = {}, v[3][block] = {},
                   xx[6][block] = {}, xv[3][block] = {};

  SINEW_INLINE void add(int lane, const Triple<L>& at, const Triple<L>& velocity) {
    const Triple<L> moment = cross<L>(at, velocity);
    const typename L::V xs[3] = {at.x, at.y, at.z}, vs[3] = {velocity.x, velocity.y, velocity.z},
                        ms[3] = {moment.x, moment.y, moment.z};
    for (int k = 0; k < 3; ++k) {
      L::store(low[k] + lane, L::smaller(xs[k], L::load(low[k] + lane)));
      L::store(high[k] + lane, L::larger(xs[k], L::load(high[k] + lane)));
      add_to<L>(x[k] + lane, xs[k]);
      add_to<L>(v[k] + lane, vs[k]);
      add_to<L>(xv[k] + lane, ms[k]);
      add_to<L>(xx[k] + lane, xs[k] * xs[k]);
      add_to<L>(xx[3 + k] + lane, xs[(k + 1) % 3] * xs[(k + 2) % 3]);
    }
  }

  Survey over_lanes() const {
    Survey all;
    for (int k = 0; k < 3; ++k) {
      all.low[k] = all.high[k] = 0;
      for (int lane = 0; lane < block; ++lane) {
        const auto least = static_cast<double>(low[k][lane]);
        const auto most = static_cast<double>(high[k][lane]);
        all.low[k] = least < all.low[k] ? least : all.low[k];
        all.high[k] = most > all.high[k] ? most : all.high[k];
      }
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
Survey survey(const SurveyInput<typename L::Real>& input, std::size_t piece,
              const typename L::Coord* center) {
  constexpr int size = Traits<typename L::Real>::block;
  const Place<L> middle{L::all_coord(center[0]), L::all_coord(center[1]), L::all_coord(center[2])};
  SurveySums<L> sums;
  const std::size_t first = piece * blocks_per_piece, last = first + blocks_per_piece;
  for (std::size_t block = first; block < last && block < input.blocks; ++block)
    for (int lane = 0; lane < size; lane += L::width) {
      const auto i = static_cast<std::ptrdiff_t>(block) * size + lane;
      const typename L::V live = live_lanes<L>(input.blocks, input.live, block, lane);
      sums.add(lane, live * offset<L>(load_place<L>(input.state.x, i), middle),
               live * load<L>(input.state.v, i));
    }
  return sums.over_lanes();
}

}  // namespace sinew::kernel
