// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/clean.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "core/number_text.h"
#include "mesh/border.h"
#include "mesh/caps.h"
#include "mesh/cleaning/merge.h"
#include "mesh/cleaning/orient.h"
#include "mesh/flat_faces.h"

namespace sinew {
namespace {

constexpr double largest_coordinate = 1e90;  // its cube and sums of that are still numbers

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
                  "give a body of a size that numbers can hold");
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
