// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/skin.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <sinew/core/cell_grid.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>

namespace sinew {
namespace {

constexpr double reach_in_radii = 6;
constexpr std::size_t min_particles = 20;  // fewer would make single particles visible
constexpr double margin = 1.05;  // h relative to the last of them, so that it has some weight
constexpr std::size_t vertices_per_piece = 512;  // and particles

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

/// The particles around a vertex and the distance h at which their weights end.
struct Support {
  std::vector<Near> near;
  double h = 0;
};

/// Empty where fewer than `wanted` particles are closer than `limit`.
std::optional<Support> support_within(const CellGrid& grid, const Points& points,
                                      const Vec3& vertex, double range, double limit,
                                      std::size_t wanted) {
  std::vector<Near> near = within(grid, points, vertex, margin * limit);
  if (near.size() < wanted || near[wanted - 1].distance >= limit) return std::nullopt;
  const double h = std::max(range, margin * near[wanted - 1].distance);
  std::erase_if(near, [&](const Near& one) { return one.distance >= h; });
  return Support{std::move(near), h};
}

/// Finds supports of vertices; searches twice as far again for the few with too few particles.
std::vector<Support> supports_of(const Points& vertices, const Points& points, double range) {
  std::vector<Support> supports(vertices.size());
  if (points.empty()) return supports;
  const std::size_t wanted = std::min(min_particles, points.size());
  std::vector<std::uint32_t> left(vertices.size());
  std::iota(left.begin(), left.end(), 0);
  for (double limit = range; !left.empty(); limit *= 2) {
    const CellGrid grid(points, margin * limit);
    std::vector<char> found(left.size());
    parallel_for(left.size(), vertices_per_piece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        if (auto support = support_within(grid, points, vertices[left[k]], range, limit, wanted))
          supports[left[k]] = *std::move(support), found[k] = 1;
    });
    std::size_t k = 0;
    std::erase_if(left, [&](std::uint32_t) { return found[k++] != 0; });
  }
  return supports;
}

void add_weights(Skin& skin, const Support& support) {
  double sum = 0;
  for (const Near& one : support.near) {
    const double rise = 1 - (one.distance / support.h) * (one.distance / support.h);
    skin.particle.push_back(one.particle);
    skin.weight.push_back(rise * rise * rise);
    sum += skin.weight.back();
  }
  for (std::size_t k = skin.first.back(); k < skin.weight.size(); ++k) skin.weight[k] /= sum;
  skin.first.push_back(static_cast<std::uint32_t>(skin.weight.size()));
}

std::vector<std::uint32_t> indices_of(const std::vector<char>& marked) {
  std::vector<std::uint32_t> indices;
  indices.reserve(static_cast<std::size_t>(std::count(marked.begin(), marked.end(), 1)));
  for (std::size_t i = 0; i < marked.size(); ++i)
    if (marked[i]) indices.push_back(static_cast<std::uint32_t>(i));
  return indices;
}

/// Marks the points closer than `range` to one that is marked.
void mark_neighbors(const CellGrid& grid, const Points& points, double range,
                    std::vector<char>& marked) {
  const std::vector<std::uint32_t> from = indices_of(marked);
  std::vector<std::vector<std::uint32_t>> found((from.size() + vertices_per_piece - 1) /
                                                vertices_per_piece);
  parallel_for(from.size(), vertices_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      grid.for_each_near(points[from[k]], [&](std::uint32_t j) {
        if (!marked[j] && (points[j] - points[from[k]]).squaredNorm() < range * range)
          found[begin / vertices_per_piece].push_back(j);
      });
  });
  for (const auto& some : found)
    for (const std::uint32_t j : some) marked[j] = 1;
}

/// The place of each of `some` of the ascending indices `all`.
std::vector<std::uint32_t> places_in(const std::vector<std::uint32_t>& all,
                                     std::vector<std::uint32_t> some) {
  for (std::uint32_t& index : some)
    index =
        static_cast<std::uint32_t>(std::lower_bound(all.begin(), all.end(), index) - all.begin());
  return some;
}

/// Keeps only what the skin needs of the body.
void add_body(Skin& skin, const Points& points, double radius) {
  const double range = rest_neighbor_range(radius);
  std::vector<char> marked(points.size());
  for (const std::uint32_t j : skin.particle) marked[j] = 1;
  const std::vector<std::uint32_t> weighted = indices_of(marked);
  skin.particle = places_in(weighted, std::move(skin.particle));
  {
    const CellGrid grid(points, range);
    for (int ring = 0; ring < 2; ++ring) mark_neighbors(grid, points, range, marked);
  }
  skin.near = indices_of(marked);
  skin.weighted = places_in(skin.near, weighted);
  Points near;
  near.reserve(skin.near.size());
  for (const std::uint32_t j : skin.near) near.push_back(points[j]);
  skin.shape = rest_shape(std::move(near), range);
}

/// Rotation of particle j, also from its neighbors' neighbors: alone it may be the end of a line.
Mat3 rotation_around(const RestShape& body, const Points& now, std::size_t j) {
  Mat3 spread = moved_spread(body, now, j);
  for (const auto k : body.neighbors.of(j)) spread += moved_spread(body, now, k);
  return rotation_part(spread);
}

/// Whether the neighbors of particle j define how it is deformed, not only how it turns.
bool follows_affinely(const RestShape& body, std::size_t j) {
  constexpr std::size_t min_neighbors = 4;
  return body.defined(j) && body.neighbors.of(j).size() >= min_neighbors;
}

Mat3 motion_at(const RestShape& body, const Points& now, std::size_t j) {
  if (!follows_affinely(body, j)) return rotation_around(body, now, j);
  const Mat3 F = deformation_gradient(body, now, j);
  const double J = F.determinant();
  const bool reliable = J > 0.3 && J < 3;
  return reliable ? F : rotation_part(F);
}

/// Whether two particles follow bones without a common joint.
bool strangers(const Skeleton& skeleton, const Binding& binding, std::uint32_t i, std::uint32_t j) {
  const int a = binding.bone(i), b = binding.bone(j);
  if (a == no_bone || b == no_bone || a == b) return false;
  return skeleton.bones[a].parent != b && skeleton.bones[b].parent != a;
}

/// The particles around a vertex that chains of touching ones connect to the nearest.
std::vector<char> reached_from_nearest(const Support& support, const Points& points, double range) {
  const std::vector<Near>& near = support.near;
  std::vector<char> reached(near.size());
  std::vector<std::size_t> next = {0};
  reached[0] = 1;
  while (!next.empty()) {
    const Vec3& from = points[near[next.back()].particle];
    next.pop_back();
    for (std::size_t k = 0; k < near.size(); ++k)
      if (!reached[k] && (points[near[k].particle] - from).squaredNorm() < range * range)
        reached[k] = 1, next.push_back(k);
  }
  return reached;
}

void drop_unrelated_particles(const Points& points, double radius, const Skeleton& skeleton,
                              const Binding& binding, Support& support) {
  if (support.near.empty()) return;
  const std::uint32_t nearest = support.near.front().particle;
  const auto is_stranger = [&](const Near& one) {
    return strangers(skeleton, binding, nearest, one.particle);
  };
  if (std::none_of(support.near.begin(), support.near.end(), is_stranger)) return;
  const auto reached = reached_from_nearest(support, points, rest_neighbor_range(radius));
  std::size_t k = 0;
  std::erase_if(support.near, [&](const Near& one) { return !reached[k++] && is_stranger(one); });
}

Skin skin_of(const Points& vertices, const Points& points, double radius,
             const std::vector<Support>& supports) {
  Skin skin;
  skin.rest = vertices;
  skin.first.push_back(0);
  for (const Support& support : supports) add_weights(skin, support);
  add_body(skin, points, radius);
  return skin;
}

}  // namespace

Skin make_skin(const Points& vertices, const Points& points, double radius) {
  return skin_of(vertices, points, radius, supports_of(vertices, points, reach_in_radii * radius));
}

Skin make_skin(const Points& vertices, const Points& points, double radius,
               const Skeleton& skeleton, const Binding& binding) {
  std::vector<Support> supports = supports_of(vertices, points, reach_in_radii * radius);
  parallel_for(supports.size(), vertices_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      drop_unrelated_particles(points, radius, skeleton, binding, supports[i]);
  });
  return skin_of(vertices, points, radius, supports);
}

Skin without_lone_particles(Skin skin) {
  std::vector<std::uint32_t> first = {0}, particle;
  std::vector<double> weight;
  for (std::size_t i = 0; i + 1 < skin.first.size(); ++i) {
    const auto kept = [&](std::uint32_t k) {
      return follows_affinely(skin.shape, skin.weighted[skin.particle[k]]);
    };
    double sum = 0;
    for (std::uint32_t k = skin.first[i]; k < skin.first[i + 1]; ++k)
      if (kept(k)) sum += skin.weight[k];
    for (std::uint32_t k = skin.first[i]; k < skin.first[i + 1]; ++k) {
      if (sum > 0 && !kept(k)) continue;
      particle.push_back(skin.particle[k]);
      weight.push_back(sum > 0 ? skin.weight[k] / sum : skin.weight[k]);
    }
    first.push_back(static_cast<std::uint32_t>(particle.size()));
  }
  skin.first = std::move(first), skin.particle = std::move(particle);
  skin.weight = std::move(weight);
  return skin;
}

Points follow(const Skin& skin, const Points& now) {
  Points near(skin.near.size());
  parallel_for(near.size(), vertices_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) near[j] = now[skin.near[j]];
  });
  std::vector<Mat3> motions(skin.weighted.size());
  parallel_for(motions.size(), vertices_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      motions[k] = motion_at(skin.shape, near, skin.weighted[k]);
  });
  Points moved(skin.rest.size(), Vec3::Zero());
  parallel_for(moved.size(), vertices_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::uint32_t k = skin.first[i]; k < skin.first[i + 1]; ++k) {
        const std::uint32_t one = skin.particle[k], j = skin.weighted[one];
        const Vec3 moved_to = near[j] + motions[one] * (skin.rest[i] - skin.shape.points[j]);
        moved[i] += skin.weight[k] * moved_to;
      }
  });
  return moved;
}

namespace {

/// Index in the body of the particle that one of the weights is of.
std::size_t particle_of(const Skin& skin, std::size_t weight) {
  return skin.near[skin.weighted[skin.particle[weight]]];
}

/// The place among the weights of the largest one of a vertex.
std::size_t largest_weight(const Skin& skin, std::size_t vertex) {
  const auto begin = skin.weight.begin();
  return static_cast<std::size_t>(
      std::max_element(begin + skin.first[vertex], begin + skin.first[vertex + 1]) - begin);
}

double mean_at(const Skin& skin, std::size_t vertex, const std::vector<double>& values,
               std::size_t component, std::size_t components) {
  double sum = 0, weights = 0;
  for (std::size_t k = skin.first[vertex]; k < skin.first[vertex + 1]; ++k) {
    const double value = values[components * particle_of(skin, k) + component];
    if (std::isnan(value)) continue;
    sum += skin.weight[k] * value;
    weights += skin.weight[k];
  }
  return weights > 0 ? sum / weights : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Column at_vertices(const Skin& skin, const Column& of_particles) {
  const auto components = static_cast<std::size_t>(of_particles.components);
  const auto interpolated = [&](const auto& values, const auto& value_at) {
    auto found = values;
    found.resize(components * skin.rest.size());
    parallel_for(skin.rest.size(), vertices_per_piece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t c = 0; c < components; ++c) found[components * i + c] = value_at(i, c);
    });
    return found;
  };
  Column found{of_particles.name, of_particles.components, {}};
  if (const auto* reals = std::get_if<std::vector<double>>(&of_particles.values))
    found.values = interpolated(
        *reals, [&](auto i, auto c) { return mean_at(skin, i, *reals, c, components); });
  else if (const auto* whole = std::get_if<std::vector<std::int32_t>>(&of_particles.values))
    found.values = interpolated(*whole, [&](auto i, auto c) {
      return (*whole)[components * particle_of(skin, largest_weight(skin, i)) + c];
    });
  return found;
}

}  // namespace sinew
