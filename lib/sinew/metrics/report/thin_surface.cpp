// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/thin_surface.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace sinew {
namespace {

using Cell = std::array<std::int64_t, 3>;

/// For each point the first one in its cell, in cells of that edge.
std::vector<std::uint32_t> first_in_cell(const Points& points, const Vec3& low, double edge) {
  std::map<Cell, std::uint32_t> first;
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Vec3 at = (points[i] - low) / edge;
    const Cell cell{std::llround(at.x()), std::llround(at.y()), std::llround(at.z())};
    out.push_back(first.try_emplace(cell, i).first->second);
  }
  return out;
}

std::size_t kept(const std::vector<std::uint32_t>& stand_in) {
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < stand_in.size(); ++i) count += stand_in[i] == i;
  return count;
}

std::vector<std::uint32_t> stand_ins(const Triangles& surface, std::size_t most) {
  std::vector<std::uint32_t> all(surface.points.size());
  std::iota(all.begin(), all.end(), 0u);
  const Box box = bounds(surface.points);
  // Cells as wide as `most` of them side by side on the skin, then wider as long as too many stay.
  double edge = std::sqrt(area(surface) / static_cast<double>(std::max<std::size_t>(most, 1)));
  for (int attempt = 0; attempt < 60 && kept(all) > most && edge > 0; ++attempt, edge *= 1.2)
    all = first_in_cell(surface.points, box.min(), edge);
  return all;
}

}  // namespace

ThinSurface thin_surface(const Triangles& surface, std::size_t most) {
  ThinSurface out;
  const std::vector<std::uint32_t> stand_in = stand_ins(surface, most);
  std::vector<int> place(stand_in.size(), -1);
  for (std::uint32_t i = 0; i < stand_in.size(); ++i)
    if (stand_in[i] == i) {
      place[i] = static_cast<int>(out.points.size());
      out.points.push_back(i);
    }
  for (const auto& face : surface.faces) {
    std::array<int, 3> corners;
    for (int c = 0; c < 3; ++c) corners[c] = place[stand_in[face[c]]];
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      out.faces.push_back(corners);
  }
  return out;
}

}  // namespace sinew
