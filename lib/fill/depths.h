// SPDX-License-Identifier: GPL-3.0-or-later
// Which components of a closed surface are around a place of a row.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "fill/row_crossings.h"
#include "mesh/surface.h"

namespace sinew {

/// The winding numbers of the components at one place of a row.
class Depths {
 public:
  void cross(int component, int winding) {
    const auto at = std::lower_bound(depths_.begin(), depths_.end(), std::array{component, -99});
    if (at == depths_.end() || (*at)[0] != component)
      depths_.insert(at, {component, winding});
    else if (((*at)[1] += winding) == 0)
      depths_.erase(at);
  }

  /// Components and their winding numbers, where these are not 0.
  const std::vector<std::array<int, 2>>& around() const { return depths_; }

  /// The first component around this place; others around it are noted as overlapping.
  int body(std::vector<std::array<int, 2>>& overlaps) const {
    int first = -1;
    for (const auto& [component, depth] : depths_) {
      if (depth <= 0) continue;
      if (first < 0)
        first = component;
      else if (overlaps.empty() || overlaps.back() != std::array{first, component})
        overlaps.push_back({first, component});
    }
    return std::max(first, 0);
  }

 private:
  std::vector<std::array<int, 2>> depths_;  ///< component and winding number, not 0
};

/// Per component: itself, or for a cavity the component whose body it hollows out.
std::vector<int> owners_of(const Surface& surface, const RowCrossings& crossings);

}  // namespace sinew
