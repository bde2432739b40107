// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/repair/diagnosis.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include <sinew/mesh/border.h>
#include <sinew/mesh/face_queries.h>
#include <sinew/repair/self_intersections.h>

namespace sinew {

Diagnosis diagnose(const Surface& surface) {
  return {self_intersections(surface.triangles), thinnest_part(surface.triangles)};
}

namespace {

/// A side of a hole.
struct HoleSide {
  int low, high, hole;
};

std::vector<HoleSide> sides_of(const std::vector<Loop>& holes) {
  std::vector<HoleSide> sides;
  for (std::size_t hole = 0; hole < holes.size(); ++hole) {
    const std::vector<int>& points = holes[hole].points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto [low, high] = std::minmax({points[i], points[(i + 1) % points.size()]});
      sides.push_back({low, high, static_cast<int>(hole)});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const HoleSide& a, const HoleSide& b) {
    return std::tuple(a.low, a.high, a.hole) < std::tuple(b.low, b.high, b.hole);
  });
  return sides;
}

int hole_at(const std::vector<HoleSide>& sides, int low, int high) {
  const auto found = std::lower_bound(
      sides.begin(), sides.end(), std::pair(low, high),
      [](const HoleSide& a, const auto& b) { return std::pair(a.low, a.high) < b; });
  return found != sides.end() && found->low == low && found->high == high ? found->hole : -1;
}

}  // namespace

Defects defects_of(const Surface& surface, const Diagnosis& diagnosis) {
  Defects defects{surface.turned, diagnosis.intersections.faces, flat_faces(surface.triangles), {}};
  const std::vector<EdgeUse> uses = edge_uses(surface.triangles);
  const std::vector<HoleSide> sides = sides_of(border_loops(uses));
  for_each_edge(uses, [&](std::span<const EdgeUse> use) {
    if (use.size() == 2 && net_count(use) == 0) return;
    const EdgeDefect defect = use.size() > 2    ? EdgeDefect::crowded
                              : use.size() == 2 ? EdgeDefect::twisted
                                                : EdgeDefect::open;
    defects.edges.push_back(
        {use[0].low, use[0].high, defect, hole_at(sides, use[0].low, use[0].high)});
  });
  return defects;
}

}  // namespace sinew
