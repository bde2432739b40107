// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/skin.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "core/cell_grid.h"
#include "core/parallel.h"

namespace sinew {
namespace {

constexpr double reach_in_radii = 6;
constexpr std::size_t least_particles = 20;  // fewer would let single particles show in the skin
constexpr double margin = 1.05;  // h beyond the last of them, which counts a little then
constexpr std::size_t vertices_per_piece = 512;

struct Near {
  double distance;
  std::uint32_t particle;
  bool operator<(const Near& other) const {
    return distance != other.distance ? distance < other.distance : particle < other.particle;
  }
};

std::vector<Near> within(const CellGrid& grid, const Points& points, const Vec3& vertex,
                         double range) {
  std::vector<Near> near;
  grid.for_each_near(vertex, [&](std::uint32_t j) {
    const double distance = (points[j] - vertex).norm();
    if (distance < range) near.push_back({distance, j});
  });
  std::sort(near.begin(), near.end());
  return near;
}

/// The particles around `vertex` and the distance h at which weights end. `grids` of doubled reach
/// are made as vertices ask for them: few do.
std::pair<std::vector<Near>, double> support(std::deque<CellGrid>& grids, const Points& points,
                                             const Vec3& vertex, double range) {
  if (points.empty()) return {{}, range};
  const std::size_t wanted = std::min(least_particles, points.size());
  double wide = range;
  for (std::size_t level = 0;; ++level, wide *= 2) {
    const double furthest = margin * wide;
    if (level == grids.size()) grids.emplace_back(points, furthest);
    std::vector<Near> near = within(grids[level], points, vertex, furthest);
    if (near.size() < wanted || near[wanted - 1].distance >= wide) continue;
    const double h = std::max(range, margin * near[wanted - 1].distance);
    std::erase_if(near, [&](const Near& one) { return one.distance >= h; });
    return {std::move(near), h};
  }
}

/// How particle j turns, seen with its neighbours' neighbours: alone it may be the end of a line.
Mat3 rotation_around(const RestShape& body, const Points& now, std::size_t j) {
  Mat3 spread = moved_spread(body, now, j);
  for (const auto k : body.neighbours.of(j)) spread += moved_spread(body, now, k);
  return rotation_part(spread);
}

Mat3 carrier(const RestShape& body, const Points& now, std::size_t j) {
  constexpr std::size_t least_neighbours = 4;
  if (!body.defined(j) || body.neighbours.of(j).size() < least_neighbours)
    return rotation_around(body, now, j);
  const Mat3 F = deformation_gradient(body, now, j);
  const double J = F.determinant();
  const bool reliable = J > 0.3 && J < 3;
  return reliable ? F : rotation_part(F);
}

}  // namespace

Skin make_skin(const Points& vertices, const RestShape& body, double radius) {
  const double range = reach_in_radii * radius;
  std::deque<CellGrid> grids;
  Skin skin;
  skin.rest = vertices;
  skin.first.push_back(0);
  for (const Vec3& vertex : vertices) {
    const auto [near, h] = support(grids, body.points, vertex, range);
    double sum = 0;
    for (const Near& one : near) {
      const double rise = 1 - (one.distance / h) * (one.distance / h);
      skin.particle.push_back(one.particle);
      skin.weight.push_back(rise * rise * rise);
      sum += skin.weight.back();
    }
    for (std::size_t k = skin.first.back(); k < skin.weight.size(); ++k) skin.weight[k] /= sum;
    skin.first.push_back(static_cast<std::uint32_t>(skin.weight.size()));
  }
  return skin;
}

Points follow(const Skin& skin, const RestShape& body, const Points& now) {
  std::vector<Mat3> carriers(now.size());
  parallel_for(now.size(), vertices_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) carriers[j] = carrier(body, now, j);
  });
  Points moved(skin.rest.size(), Vec3::Zero());
  parallel_for(moved.size(), vertices_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::uint32_t k = skin.first[i]; k < skin.first[i + 1]; ++k) {
        const std::uint32_t j = skin.particle[k];
        moved[i] += skin.weight[k] * (now[j] + carriers[j] * (skin.rest[i] - body.points[j]));
      }
  });
  return moved;
}

}  // namespace sinew
