// SPDX-License-Identifier: GPL-3.0-or-later
// Sites of the FCC lattice by parity: integers i, j, k with an even sum, in units of sqrt(2) r.
//
//     const FccSite site = nearest_fcc_site(point / unit);
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

using FccSite = std::array<int, 3>;

/// The site nearest to a point, both in units of the lattice.
inline FccSite nearest_fcc_site(const Vec3& at) {
  FccSite site;
  int sum = 0, worst = 0;
  double most = -1;
  for (int axis = 0; axis < 3; ++axis) {
    site[axis] = static_cast<int>(std::lround(at[axis]));
    sum += site[axis];
    const double off = std::abs(at[axis] - site[axis]);
    if (off > most) most = off, worst = axis;
  }
  if (sum % 2 != 0) site[worst] += at[worst] > site[worst] ? 1 : -1;
  return site;
}

/// Steps from a site to those at most `reach` units away, itself included.
inline std::vector<FccSite> fcc_steps(int reach = 2) {
  std::vector<FccSite> steps;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      for (int k = -reach; k <= reach; ++k)
        if ((i + j + k) % 2 == 0 && i * i + j * j + k * k <= reach * reach)
          steps.push_back({i, j, k});
  return steps;
}

}  // namespace sinew
