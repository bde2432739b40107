// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/clean.h>

#include <algorithm>
#include <limits>
#include <string>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/mesh/border.h>
#include <sinew/mesh/detail/orient.h>
#include <sinew/mesh/detail/triangulate.h>
#include <sinew/mesh/detail/walls.h>
#include <sinew/mesh/face_queries.h>
#include <sinew/mesh/surface.h>

namespace sinew {

namespace {

void check_polygon(const std::vector<int>& polygon, std::size_t points) {
  const std::string cure = "export the mesh again";
  if (polygon.size() < 3)
    throw bad_input("a face has " + std::to_string(polygon.size()) + " corners", cure);
  for (const int corner : polygon)
    if (corner < 0 || static_cast<std::size_t>(corner) >= points)
      throw bad_input("a face names vertex " + std::to_string(corner) + " of " +
                          std::to_string(points) + " (counted from 0)",
                      cure);
}

}  // namespace

void check_soup(const PolygonSoup& soup) {
  if (soup.polygons.empty())
    throw bad_input("there are no faces", "export the mesh with its faces");
  if (soup.points.size() > std::numeric_limits<int>::max())
    throw bad_input("there are " + std::to_string(soup.points.size()) + " points",
                    "reduce the number of triangles");
  for (std::size_t i = 0; i < soup.points.size(); ++i)
    if (!is_computable(soup.points[i]))
      throw bad_input("vertex " + std::to_string(i) + " has a coordinate that is not finite",
                      "export the mesh again");
  for (const auto& polygon : soup.polygons) check_polygon(polygon, soup.points.size());
}

PolygonSoup soup_of(const Triangles& triangles) {
  PolygonSoup soup{triangles.points, {}};
  soup.polygons.reserve(triangles.faces.size());
  for (const auto& face : triangles.faces) soup.polygons.emplace_back(face.begin(), face.end());
  return soup;
}

namespace {

constexpr double largest_coordinate = 1e90;  // its cube and sums of cubes do not overflow

void refuse_empty(const Triangles& triangles, const CleaningCounts& counts) {
  if (!triangles.faces.empty()) return;
  throw bad_input("all " + std::to_string(counts.polygons_read) + " faces are collapsed",
                  counts.points_merged > 0 ? "give a smaller weld distance or export the mesh again"
                                           : "export the mesh again");
}

void refuse_large(const Points& points) {
  double largest = 0;
  for (const Vec3& point : points) largest = std::max(largest, point.cwiseAbs().maxCoeff());
  if (largest <= largest_coordinate) return;
  throw bad_input("a coordinate is " + three_digits(largest) + " m from 0, more than 1e+90 m",
                  "scale the body down, or set its unit");
}

void turn(Surface& surface, std::vector<EdgeUse>& uses) {
  for (std::size_t i = 0; i < surface.turned.size(); ++i)
    if (surface.turned[i]) std::swap(surface.triangles.faces[i][1], surface.triangles.faces[i][2]);
  for (EdgeUse& use : uses) use.forward = use.forward != surface.turned[use.face];
  surface.cleaning.faces_turned = std::count(surface.turned.begin(), surface.turned.end(), true);
}

void close_holes(Surface& surface, std::span<const EdgeUse> uses) {
  const std::vector<Loop> holes = border_loops(uses);
  surface.border = border_of(surface.triangles, uses, holes);
  surface.caps = caps_of(holes, surface.triangles.points);
}

/// The second half of clean().
Surface oriented(Triangles triangles, FillRule rule) {
  Surface surface;
  surface.triangles = std::move(triangles);
  refuse_large(surface.triangles.points);
  std::vector<EdgeUse> uses = edge_uses(surface.triangles);
  const Patches patches = patches_of(surface.triangles, uses);
  surface.cleaning.edges_twisted = patches.twisted_edges;
  Components components = components_of(patches, uses);
  surface.turned = faces_to_turn(surface.triangles, uses, patches, components, rule);
  surface.component = std::move(components.of_face);
  surface.components = components.count;
  turn(surface, uses);
  close_holes(surface, uses);
  const std::vector<bool> flat = flat_faces(surface.triangles);
  surface.cleaning.faces_flat = std::count(flat.begin(), flat.end(), true);
  return surface;
}

/// Faces of which some are walls.
class WalledFaces {
 public:
  WalledFaces(const DistinctFaces& faces, FillRule rule)
      : triangles_(faces.triangles), rule_(rule), kinds_(kinds_of(triangles_, faces.opposed)) {}

  /// The faces but walls, which part its components. Groups alone are walls within the others.
  Surface surface() {
    for (const auto& group : kinds_.alone) set_walls(group, rule_ == FillRule::unite);
    Triangles outline = chosen(false);
    if (outline.faces.empty()) {
      for (const auto& group : kinds_.alone) set_walls(group, false);
      return oriented(chosen(false), rule_);
    }
    Surface surface = oriented(std::move(outline), rule_);
    if (keep_outer(surface)) surface = oriented(chosen(false), rule_);
    part(surface, chosen(true));
    return surface;
  }

 private:
  void set_walls(const std::vector<int>& group, bool walls) {
    for (const int face : group) kinds_.wall[face] = walls;
  }

  Triangles chosen(bool walls) const {
    std::vector<std::array<int, 3>> faces;
    for (std::size_t i = 0; i < triangles_.faces.size(); ++i)
      if (kinds_.wall[i] == walls) faces.push_back(triangles_.faces[i]);
    return used(triangles_.points, std::move(faces));
  }

  /// Returns whether there were groups alone that are not within the others.
  bool keep_outer(const Surface& others) {
    if (kinds_.alone.empty() || rule_ != FillRule::unite) return false;
    const Winding winding = winding_of(others);
    bool kept = false;
    for (const std::vector<int>& group : kinds_.alone) {
      std::vector<Corners> corners;
      for (const int face : group) {
        const auto& [a, b, c] = triangles_.faces[face];
        corners.push_back({triangles_.points[a], triangles_.points[b], triangles_.points[c]});
      }
      if (encloses(winding, corners)) continue;
      set_walls(group, false);
      kept = true;
    }
    return kept;
  }

  const Triangles& triangles_;
  FillRule rule_;
  FaceKinds kinds_;
};

bool any(const std::vector<bool>& flags) {
  return std::find(flags.begin(), flags.end(), true) != flags.end();
}

/// Completes the counts of distinct faces by those of the surface.
void add_counts(const CleaningCounts& counts, Surface& surface) {
  CleaningCounts& all = surface.cleaning;
  for (const NamedCount& row : cleaning_counts()) all.*row.count += counts.*row.count;
  all.points_unused = all.points_read - all.points_merged - surface.triangles.points.size();
  all.faces_shared = surface.walls.triangles.faces.size();
  all.faces_doubled -= all.faces_shared;
}

}  // namespace

Surface clean(const PolygonSoup& soup, const CleaningOptions& options) {
  CleaningCounts counts;
  DistinctFaces faces = distinct_faces(soup, options.weld, counts);
  refuse_empty(faces.triangles, counts);
  Surface surface =
      any(faces.opposed)
          ? WalledFaces(faces, options.rule).surface()
          : oriented(used(faces.triangles.points, std::move(faces.triangles.faces)), options.rule);
  add_counts(counts, surface);
  return surface;
}

}  // namespace sinew
