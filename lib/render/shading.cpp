// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/shading.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace sinew {
namespace {

struct Side {
  int face, corner;  ///< the side goes from this corner of the face to the next
};
using Sides =
    std::map<Shading::Edge, std::vector<Side>>;  // ordered: pictures do not depend on hashing

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
  const bool quadrangles = 2 * diagonals.size() > 0.95 * rest.faces.size();
  if (!quadrangles) skin.lines.insert(skin.lines.end(), diagonals.begin(), diagonals.end());
  return skin;
}

}  // namespace sinew
