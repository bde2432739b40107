// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/caps.h"

namespace sinew {
namespace {

/// The part of a loop from its point `from` to its point `to`, whose chord the rest of the cap has.
void cut_off(int first, int from, int to, Triangles& caps) {
  if (to - from < 2) return;
  const int middle = from + (to - from) / 2;
  caps.faces.push_back({first + to, first + middle, first + from});
  cut_off(first, from, middle, caps);
  cut_off(first, middle, to, caps);
}

}  // namespace

void add_cap(const Loop& loop, const Points& points, Triangles& caps) {
  const int first = static_cast<int>(caps.points.size());
  const int count = static_cast<int>(loop.points.size());
  for (const int point : loop.points) caps.points.push_back(points[point]);
  cut_off(first, 0, count - 1, caps);
}

Triangles caps_of(std::span<const Loop> loops, const Points& points) {
  Triangles caps;
  for (const Loop& loop : loops) add_cap(loop, points, caps);
  return caps;
}

}  // namespace sinew
