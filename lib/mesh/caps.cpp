// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/caps.h"

namespace sinew {

void add_cap(const Loop& loop, const Points& points, Triangles& caps) {
  const int first = static_cast<int>(caps.points.size()),
            count = static_cast<int>(loop.points.size());
  Vec3 middle = Vec3::Zero();
  for (const int point : loop.points) {
    caps.points.push_back(points[point]);
    middle += points[point] / count;
  }
  if (count == 3) {
    caps.faces.push_back({first + 2, first + 1, first});
    return;
  }
  for (int i = 0; i < count; ++i)
    caps.faces.push_back({first + (i + 1) % count, first + i, first + count});
  caps.points.push_back(middle);
}

Triangles caps_of(std::span<const Loop> loops, const Points& points) {
  Triangles caps;
  for (const Loop& loop : loops) add_cap(loop, points, caps);
  return caps;
}

}  // namespace sinew
