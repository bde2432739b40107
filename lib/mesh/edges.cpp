// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/edges.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <tuple>
#include <utility>

#include "core/error.h"

namespace sinew {
namespace {

std::string place_text(const Vec3& p) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g)", p.x(), p.y(), p.z());
  return text;
}

std::string span_text(const Triangles& surface, const EdgeUse& use) {
  return place_text(surface.points[use.low]) + " to " + place_text(surface.points[use.high]);
}

std::string edges_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " edge" : " edges");
}

/// Sets of faces with the direction of each face against its set's first.
class OrientedSets {
 public:
  explicit OrientedSets(std::size_t faces) : parent_(faces), turned_(faces, false) {
    for (std::size_t i = 0; i < faces; ++i) parent_[i] = static_cast<int>(i);
  }

  struct Root {
    int face;
    bool turned;
  };

  Root find(int face) {
    Root root{face, false};
    while (parent_[root.face] != root.face) {
      root.turned = root.turned != turned_[root.face];
      root.face = parent_[root.face];
    }
    bool turned = root.turned;  // shorten the way for the next time
    while (parent_[face] != root.face && face != root.face) {
      const bool step = turned_[face];
      turned_[face] = turned;
      turned = turned != step;
      face = std::exchange(parent_[face], root.face);
    }
    return root;
  }

  /// Joins two faces; false when they are joined already in the other direction.
  bool join(int a, int b, bool turned) {
    const Root ra = find(a), rb = find(b);
    const bool between = turned != (ra.turned != rb.turned);
    if (ra.face == rb.face) return !between;
    const auto [first, later] =
        std::minmax(ra.face, rb.face);  // the first face keeps its direction
    parent_[later] = first;
    turned_[later] = between;
    return true;
  }

 private:
  std::vector<int> parent_;
  std::vector<bool> turned_;
};

}  // namespace

std::vector<EdgeUse> edge_uses(const std::vector<std::array<int, 3>>& faces) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (int side = 0; side < 3; ++side) {
      const int from = faces[i][side], to = faces[i][(side + 1) % 3];
      uses.push_back({std::min(from, to), std::max(from, to), static_cast<int>(i), from < to});
    }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
  });
  return uses;
}

void refuse_open(const Triangles& surface, std::span<const EdgeUse> uses) {
  std::size_t edges = 0, open = 0, crowded = 0;
  const EdgeUse* first_open = nullptr;
  const EdgeUse* first_crowded = nullptr;
  for_each_edge(uses, [&](std::span<const EdgeUse> use) {
    ++edges;
    if (use.size() == 1 && ++open == 1) first_open = &use[0];
    if (use.size() > 2 && ++crowded == 1) first_crowded = &use[0];
  });
  if (crowded > 0)
    throw bad_input(edges_text(crowded) + " of " + std::to_string(edges) +
                        " join more than two faces, the first from " +
                        span_text(surface, *first_crowded),
                    "separate the parts or join them with a boolean union");
  if (open > 0)
    throw bad_input("the surface is open: " + edges_text(open) + " of " + std::to_string(edges) +
                        " have one face only, the first from " + span_text(surface, *first_open),
                    "close the holes in the mesh editor");
}

Shells shells_of(const Triangles& surface, std::span<const EdgeUse> uses) {
  OrientedSets sets(surface.faces.size());
  std::size_t conflicts = 0;
  for_each_edge(uses, [&](std::span<const EdgeUse> use) {
    conflicts += !sets.join(use[0].face, use[1].face, use[0].forward == use[1].forward);
  });
  if (conflicts > 0)
    throw bad_input(
        "the surface has one side only (as a Klein bottle): no directions of its faces "
        "agree at " +
            edges_text(conflicts),
        "give a surface with an inside");
  Shells shells{std::vector<int>(surface.faces.size()), {}, 0};
  for (std::size_t i = 0; i < surface.faces.size(); ++i) {
    const auto root = sets.find(static_cast<int>(i));
    const bool first = root.face == static_cast<int>(i);
    shells.of_face[i] = first ? shells.count++ : shells.of_face[root.face];
    shells.turned.push_back(root.turned);
  }
  return shells;
}

}  // namespace sinew
