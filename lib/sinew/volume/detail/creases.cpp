// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/volume/detail/creases.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <sinew/core/cell_grid.h>

namespace sinew {
namespace {

constexpr double sharpest_smooth = 0.77;  // cosine of 40 degrees between two normals
constexpr double straight = 0.77;         // the same between two edges that go on
constexpr double samples = 0.25;          // radii between points of a crease that are looked for
constexpr double edge_reach = 1.5, corner_reach = 2.0;  // radii that points may move
constexpr double side = 0.05;                           // radii in front of a crease and behind it
constexpr double flat_cell = 12;                        // degrees

/// A place on a crease.
struct CreasePoint {
  Vec3 place, outward;                                      ///< m; the mean of the normals there
  std::array<Vec3, 2> edge = {Vec3::Zero(), Vec3::Zero()};  ///< its ends; unused for corners
};

struct Creases {
  std::vector<CreasePoint> edges, corners;
};

Vec3 nearest_on(const std::array<Vec3, 2>& edge, const Vec3& point) {
  const Vec3 along = edge[1] - edge[0];
  const double at = along.dot(point - edge[0]) / along.squaredNorm();
  return edge[0] + std::clamp(at, 0.0, 1.0) * along;
}

void add_edge(const Vec3& a, const Vec3& b, const Vec3& outward, double spacing, Creases& found) {
  const int parts = static_cast<int>(std::ceil((b - a).norm() / spacing));
  for (int k = 0; k <= parts; ++k)
    found.edges.push_back({a + (b - a) * k / std::max(1, parts), outward, {a, b}});
}

/// The sharp edges of two faces, and the points where they end, branch or turn.
Creases creases_of(const Triangles& surface, double spacing) {
  std::map<std::array<int, 2>, std::vector<Vec3>> normals;
  for (const auto& face : surface.faces) {
    const Vec3 normal = area_vector(surface, face).normalized();
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(face[k], face[(k + 1) % 3]);
      normals[{a, b}].push_back(normal);
    }
  }
  Creases found;
  std::map<int, std::vector<CreasePoint>> at_points;  // directions as places
  for (const auto& [edge, of_faces] : normals) {
    if (of_faces.size() != 2 || !(of_faces[0].dot(of_faces[1]) < sharpest_smooth)) continue;
    const Vec3 &a = surface.points[edge[0]], &b = surface.points[edge[1]];
    const Vec3 outward = (of_faces[0] + of_faces[1]).normalized();
    if (!outward.allFinite()) continue;
    add_edge(a, b, outward, spacing, found);
    at_points[edge[0]].push_back({(b - a).normalized(), outward});
    at_points[edge[1]].push_back({(a - b).normalized(), outward});
  }
  for (const auto& [point, edges] : at_points) {
    if (edges.size() == 2 && -edges[0].place.dot(edges[1].place) > straight) continue;
    Vec3 outward = Vec3::Zero();
    for (const CreasePoint& edge : edges) outward += edge.outward;
    found.corners.push_back({surface.points[point], outward.normalized()});
  }
  return found;
}

struct Snap {
  double distance;
  std::uint32_t point;
  Vec3 place;
};

bool before(const Snap& a, const Snap& b) {
  return std::pair(a.distance, a.point) < std::pair(b.distance, b.point);
}

class Snapping {
 public:
  Snapping(VolumeCells& body, std::span<const BorderFace> border, const InsideSpace& space,
           double radius)
      : body_(body), space_(space), radius_(radius), moved_(body.points.size()) {
    std::set<std::uint32_t> points;
    for (const BorderFace& face : border)
      for (const std::uint32_t v : face)
        if (body.id[v] < 0) points.insert(v);
    border_.assign(points.begin(), points.end());
  }

  void snap() {
    const Creases creases = creases_of(space_.surface(), samples * radius_);
    if (creases.edges.empty()) return;
    const CellsOfPoint cells(body_);
    apply(to_corners(creases.corners), cells);
    apply(to_edges(creases.edges), cells);
  }

  std::vector<char> moved() && { return std::move(moved_); }

 private:
  bool counts(const CreasePoint& crease) const {
    return space_.is_border(crease.place, side * radius_ * crease.outward);
  }

  /// The point next to each corner.
  std::vector<Snap> to_corners(const std::vector<CreasePoint>& corners) const {
    std::vector<Snap> moves;
    Points places;
    for (const std::uint32_t v : border_) places.push_back(body_.points[v]);
    const CellGrid grid(places, corner_reach * radius_);
    for (const CreasePoint& corner : corners) {
      Snap nearest{corner_reach * radius_, 0, corner.place};
      bool any = false;
      grid.for_each_near(corner.place, [&](std::uint32_t k) {
        const Snap one{(places[k] - corner.place).norm(), border_[k], corner.place};
        if (before(one, nearest)) nearest = one, any = true;
      });
      if (any && counts(corner)) moves.push_back(nearest);
    }
    return moves;
  }

  std::vector<Snap> to_edges(const std::vector<CreasePoint>& edges) const {
    std::vector<Snap> moves;
    Points places;
    for (const CreasePoint& edge : edges) places.push_back(edge.place);
    const CellGrid grid(places, edge_reach * radius_);
    for (const std::uint32_t v : border_) {
      Snap nearest{edge_reach * radius_, v, Vec3::Zero()};
      const CreasePoint* on = nullptr;
      grid.for_each_near(body_.points[v], [&](std::uint32_t k) {
        const Vec3 place = nearest_on(edges[k].edge, body_.points[v]);
        const double distance = (place - body_.points[v]).norm();
        if (distance < nearest.distance) nearest = {distance, v, place}, on = &edges[k];
      });
      if (on && counts({nearest.place, on->outward})) moves.push_back(nearest);
    }
    return moves;
  }

  void apply(std::vector<Snap> moves, const CellsOfPoint& cells) {
    std::sort(moves.begin(), moves.end(), before);
    for (const Snap& move : moves)
      if (!moved_[move.point] && cells.move(body_, move.point, move.place, flat_cell))
        moved_[move.point] = 1;
  }

  VolumeCells& body_;
  const InsideSpace& space_;
  double radius_;
  std::vector<char> moved_;
  std::vector<std::uint32_t> border_;  ///< points that may move
};

}  // namespace

std::vector<char> snap_to_creases(VolumeCells& body, std::span<const BorderFace> border,
                                  const InsideSpace& space, double radius) {
  Snapping snapping(body, border, space, radius);
  snapping.snap();
  return std::move(snapping).moved();
}

}  // namespace sinew
