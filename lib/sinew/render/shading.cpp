// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/shading.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include <sinew/core/parallel.h>
#include <sinew/core/vector.h>

namespace sinew {

namespace {

struct Side {
  int face, corner;  ///< the side from this corner of the face to the next
};
// Ordered: pictures do not depend on hashing.
using Sides = std::map<Shading::Edge, std::vector<Side>>;

Sides sides_of(const Triangles& surface) {
  Sides sides;
  for (int f = 0; f < static_cast<int>(surface.faces.size()); ++f)
    for (int c = 0; c < 3; ++c) {
      const auto [low, high] = std::minmax(surface.faces[f][c], surface.faces[f][(c + 1) % 3]);
      sides[{low, high}].push_back({f, c});
    }
  return sides;
}

Vec3 normal(const Triangles& surface, int face) {
  const auto& [a, b, c] = surface.faces[face];
  const Points& p = surface.points;
  return (p[b] - p[a]).cross(p[c] - p[a]).normalized();
}

bool smooth(const Triangles& surface, const std::vector<Side>& sides) {
  if (sides.size() != 2) return false;
  const double cosine = normal(surface, sides[0].face).dot(normal(surface, sides[1].face));
  return cosine > std::cos(radians(40));
}

bool longest(const Triangles& surface, const Side& side) {
  std::array<double, 3> length;
  for (int c = 0; c < 3; ++c)
    length[c] = (surface.points[surface.faces[side.face][c]] -
                 surface.points[surface.faces[side.face][(c + 1) % 3]])
                    .norm();
  const double own = std::exchange(length[side.corner], 0.0);
  return own > 1.01 * *std::max_element(length.begin(), length.end());
}

int root(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Joins the corners of two faces at both ends of their common side; corner c of face f is 3 f + c.
void join(const Triangles& surface, const Side& a, const Side& b, std::vector<int>& parent) {
  for (const int i : {a.corner, (a.corner + 1) % 3})
    for (const int k : {b.corner, (b.corner + 1) % 3})
      if (surface.faces[a.face][i] == surface.faces[b.face][k])
        parent[root(parent, 3 * a.face + i)] = root(parent, 3 * b.face + k);
}

double mean_length(const Points& points, const std::vector<Shading::Edge>& edges) {
  double sum = 0;
  for (const auto& [a, b] : edges) sum += (points[a] - points[b]).norm();
  return edges.empty() ? 0 : sum / static_cast<double>(edges.size());
}

/// Corners joined by smooth edges share one shaded point.
void split(const Triangles& rest, std::vector<int>& parent, Shading& skin) {
  std::vector<int> shaded(parent.size(), -1);
  for (int f = 0; f < static_cast<int>(rest.faces.size()); ++f) {
    std::array<int, 3> face;
    for (int c = 0; c < 3; ++c) {
      int& point = shaded[root(parent, 3 * f + c)];
      if (point < 0) {
        point = static_cast<int>(skin.source.size());
        skin.source.push_back(rest.faces[f][c]);
      }
      face[c] = point;
    }
    skin.faces.push_back(face);
  }
}

}  // namespace

Triangles Shading::at(const Points& points) const {
  Triangles shaded{Points(source.size()), faces};
  for (std::size_t i = 0; i < source.size(); ++i) shaded.points[i] = points[source[i]];
  return shaded;
}

Shading make_shading(const Triangles& rest) {
  Shading skin;
  std::vector<int> parent(3 * rest.faces.size());
  std::iota(parent.begin(), parent.end(), 0);
  std::vector<Shading::Edge> diagonals;
  for (const auto& [edge, sides] : sides_of(rest)) {
    if (!smooth(rest, sides)) {
      skin.creases.push_back(edge);
      continue;
    }
    join(rest, sides[0], sides[1], parent);
    const bool diagonal = longest(rest, sides[0]) && longest(rest, sides[1]);
    (diagonal ? diagonals : skin.lines).push_back(edge);
  }
  split(rest, parent, skin);
  const bool quadrangles =
      2 * static_cast<double>(diagonals.size()) > 0.95 * static_cast<double>(rest.faces.size());
  if (!quadrangles) skin.lines.insert(skin.lines.end(), diagonals.begin(), diagonals.end());
  skin.mean_line = mean_length(rest.points, skin.lines);
  return skin;
}

namespace {

constexpr int samples = 16, rotations = 16;  // a 4 x 4 pattern of rotations, blurred afterwards

struct Offset {
  int x, y;
  float distance;  ///< m
};
using Discs = std::array<std::array<Offset, samples>, rotations>;

/// A sunflower pattern, evenly over the disc, once for each rotation.
Discs make_discs(double radius, double pixel) {
  constexpr double golden_angle = 2.399963;
  Discs discs;
  for (int turn = 0; turn < rotations; ++turn)
    for (int i = 0; i < samples; ++i) {
      const double far = std::max(1.0, radius / pixel * std::sqrt((i + 0.5) / samples));
      const double angle = golden_angle * i + 2 * pi * turn / rotations;
      const int x = static_cast<int>(std::lround(far * std::cos(angle)));
      const int y = static_cast<int>(std::lround(far * std::sin(angle)));
      discs[turn][i] = {x, y, static_cast<float>(pixel * std::hypot(x, y))};
    }
  return discs;
}

/// Infinite outside of the picture, as in the background.
float depth_at(const DepthImage& image, int x, int y) {
  const bool inside = x >= 0 && y >= 0 && x < image.width && y < image.height;
  return inside ? image.at(x, y) : std::numeric_limits<float>::infinity();
}

/// Change of depth per pixel: of both sides the smaller, since the other may be another object.
float slope(float before, float here, float after) {
  const float left = here - before, right = after - here;
  const float flatter = std::abs(left) < std::abs(right) ? left : right;
  return std::isfinite(flatter) ? flatter : 0;
}

float hidden(const DepthImage& image, const Discs& discs, float radius, int x, int y) {
  const float here = image.at(x, y);
  if (!std::isfinite(here)) return 0;
  const float along_x = slope(depth_at(image, x - 1, y), here, depth_at(image, x + 1, y));
  const float along_y = slope(depth_at(image, x, y - 1), here, depth_at(image, x, y + 1));
  constexpr std::array<int, rotations> order{0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
  float sum = 0;
  for (const auto& [dx, dy, distance] : discs[order[4 * (y % 4) + x % 4]]) {
    const float plane = here + along_x * static_cast<float>(dx) + along_y * static_cast<float>(dy);
    const float above = plane - depth_at(image, x + dx, y + dy);
    if (!(above > 0.04F * radius)) continue;  // includes the background: infinitely far below
    const float near = radius / std::max(radius, above);  // objects far in front hide less
    sum += near * near * above / std::sqrt(above * above + distance * distance);
  }
  return sum / samples;
}

/// The mean of 4 x 4 pixels, at those that are not background.
std::vector<float> blurred(const std::vector<float>& values, const DepthImage& image) {
  const int width = image.width, height = image.height;
  std::vector<float> means(values.size());
  parallel_for(static_cast<std::size_t>(height), 16, [&](std::size_t begin, std::size_t end) {
    std::vector<float> sums(static_cast<std::size_t>(width));  // sums of 4 rows
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      std::fill(sums.begin(), sums.end(), 0.0F);
      for (int row = y - 1; row < y + 3; ++row) {
        const float* there =
            &values[static_cast<std::size_t>(std::clamp(row, 0, height - 1)) * width];
        for (int x = 0; x < width; ++x) sums[x] += there[x];
      }
      for (int x = 0; x < width; ++x) {
        if (!std::isfinite(image.at(x, y))) continue;
        float sum = 0;
        for (int column = x - 1; column < x + 3; ++column)
          sum += sums[std::clamp(column, 0, width - 1)];
        means[static_cast<std::size_t>(y) * width + x] = sum / 16;
      }
    }
  });
  return means;
}

}  // namespace

std::vector<float> occlusion(const DepthImage& image, double radius) {
  const Discs discs = make_discs(radius, image.pixel);
  std::vector<float> result(image.depth.size());
  parallel_for(static_cast<std::size_t>(image.height), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < image.width; ++x)
        result[static_cast<std::size_t>(y) * image.width + x] =
            hidden(image, discs, static_cast<float>(radius), x, y);
  });
  return blurred(result, image);
}

}  // namespace sinew
