// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/clean.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/settings_table.h"
#include "mesh/edges.h"
#include "mesh/merge.h"
#include "mesh/nesting.h"
#include "mesh/self_intersections.h"

namespace sinew {
namespace {

// A volume this small against area times size is what rounding leaves of a flat body.
constexpr double rounding = 1e-13;

void refuse(const SelfIntersections& found) {
  if (found.pairs == 0) return;
  throw bad_input((found.complete ? "" : "at least ") + std::to_string(found.pairs) +
                      " pairs of faces cut or touch each other, the first faces " +
                      std::to_string(found.first[0]) + " and " + std::to_string(found.first[1]) +
                      " (counted from 0)",
                  "separate the parts or join them with a boolean union");
}

void turn(std::array<int, 3>& face) { std::swap(face[1], face[2]); }

/// Volume of each shell as its faces turn, m^3.
std::vector<double> volumes(const Triangles& surface, const Shells& shells) {
  std::vector<double> sums(shells.count);
  const Vec3 centre = bounds(surface.points).center();
  for (std::size_t i = 0; i < surface.faces.size(); ++i) {
    const auto& [a, b, c] = surface.faces[i];
    const Vec3 from_b = surface.points[b] - centre;
    sums[shells.of_face[i]] +=
        (surface.points[a] - centre).dot(from_b.cross(surface.points[c] - centre)) / 6;
  }
  return sums;
}

/// Bodies outward, cavities inward; counts the faces turned against the file.
void orient(Surface& surface, Shells& shells, const Nesting& nesting) {
  const std::vector<double> volume_of = volumes(surface.triangles, shells);
  for (std::size_t i = 0; i < shells.of_face.size(); ++i) {
    const int shell = shells.of_face[i];
    if ((volume_of[shell] < 0) != nesting.cavity[shell]) {
      turn(surface.triangles.faces[i]);
      shells.turned[i] = !shells.turned[i];
    }
    surface.body.push_back(nesting.body[shell]);
  }
  surface.cleaning.faces_turned = std::count(shells.turned.begin(), shells.turned.end(), true);
}

void refuse_without_volume(const Triangles& surface) {
  const double enclosed = volume(surface), skin = area(surface);
  const double size = bounds(surface.points).diagonal().norm();
  if (std::isfinite(enclosed) && std::isfinite(skin * size) && enclosed > rounding * skin * size)
    return;
  throw bad_input("the surface encloses a volume of " + number_text(enclosed) +
                      " m^3 with an area of " + number_text(skin) + " m^2",
                  "give a solid body of a size that numbers can hold");
}

}  // namespace

Surface clean(PolygonSoup soup) {
  Surface surface;
  surface.triangles = merged_triangles(std::move(soup), surface.cleaning);
  if (surface.triangles.faces.empty())
    throw bad_input(
        "all " + std::to_string(surface.cleaning.polygons_read) + " faces are collapsed",
        "export the mesh again");
  const std::vector<EdgeUse> uses = edge_uses(surface.triangles.faces);
  refuse_open(surface.triangles, uses);
  Shells shells = shells_of(surface.triangles, uses);
  for (std::size_t i = 0; i < shells.turned.size(); ++i)
    if (shells.turned[i]) turn(surface.triangles.faces[i]);
  const SelfIntersections found = self_intersections(surface.triangles);
  refuse(found);
  surface.cleaning.faces_flat = found.flat;
  const Nesting nesting = nesting_of(surface.triangles, shells);
  orient(surface, shells, nesting);
  refuse_without_volume(surface.triangles);
  surface.bodies = nesting.bodies;
  surface.cavities = shells.count - nesting.bodies;
  return surface;
}

}  // namespace sinew
