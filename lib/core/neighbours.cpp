// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/neighbours.h"

#include <algorithm>

#include "core/cell_grid.h"

namespace sinew {

NeighbourLists neighbours_within(const Points& points, double range) {
  const CellGrid grid(points, range);
  NeighbourLists lists;
  lists.first.push_back(0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    grid.for_each_near(points[i], [&](std::uint32_t j) {
      if (j != i && (points[j] - points[i]).squaredNorm() < range * range)
        lists.partner.push_back(j);
    });
    std::sort(lists.partner.begin() + lists.first.back(), lists.partner.end());
    lists.first.push_back(static_cast<std::uint32_t>(lists.partner.size()));
  }
  return lists;
}

}  // namespace sinew
