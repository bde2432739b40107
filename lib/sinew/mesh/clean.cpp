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

namespace {

constexpr double largest_coordinate = 1e90;  // its cube and sums of cubes do not overflow

void refuse_empty(const Surface& surface) {
  if (!surface.triangles.faces.empty()) return;
  throw bad_input("all " + std::to_string(surface.cleaning.polygons_read) + " faces are collapsed",
                  surface.cleaning.points_merged > 0
                      ? "give a smaller weld distance or export the mesh again"
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

}  // namespace

Surface clean(const PolygonSoup& soup, const CleaningOptions& options) {
  Surface surface;
  surface.triangles = merged_triangles(soup, options.weld, surface.cleaning);
  refuse_empty(surface);
  refuse_large(surface.triangles.points);
  std::vector<EdgeUse> uses = edge_uses(surface.triangles);
  const Patches patches = patches_of(surface.triangles, uses);
  surface.cleaning.edges_twisted = patches.twisted_edges;
  Components components = components_of(patches, uses);
  surface.turned = faces_to_turn(surface.triangles, uses, patches, components, options.rule);
  surface.component = std::move(components.of_face);
  surface.components = components.count;
  turn(surface, uses);
  close_holes(surface, uses);
  const std::vector<bool> flat = flat_faces(surface.triangles);
  surface.cleaning.faces_flat = std::count(flat.begin(), flat.end(), true);
  return surface;
}

}  // namespace sinew
