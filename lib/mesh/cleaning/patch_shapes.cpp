// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cleaning/patch_shapes.h"

#include <cmath>
#include <cstdlib>

#include "mesh/caps.h"
#include "mesh/measures.h"

namespace sinew {
namespace {

// Area vector over area. Pieces of a sphere, a torus and a bumpy ball from which 5 % to 60 % of the
// faces are taken at random enclose the right sign up to 0.75; from 0.8 on some do not.
constexpr double flattest = 0.7;
// Volume over area^(3/2): 0.09 for a sphere, 0.004 for a plate of 1 : 1 : 0.01.
constexpr double thinnest = 1e-3;

std::vector<Loop> loops_of(std::span<const EdgeUse> uses, const Patches& patches) {
  std::vector<BorderEdge> border;
  for_each_edge(uses, [&](std::span<const EdgeUse> use) {
    for_each_border(use, patches, [&](int patch, int count) {
      const BorderEdge edge = count > 0 ? BorderEdge{patch, use[0].low, use[0].high}
                                        : BorderEdge{patch, use[0].high, use[0].low};
      border.insert(border.end(), std::abs(count), edge);
    });
  });
  return simple_loops(std::move(border));
}

}  // namespace

bool PatchShape::decides() const {
  if (closed) return std::abs(volume) > volume_rounding(area, box);
  return area_vector.norm() < flattest * area && std::abs(volume) > thinnest * std::pow(area, 1.5);
}

PatchShapes shapes_of(const Triangles& surface, std::span<const EdgeUse> uses,
                      const Patches& patches) {
  PatchShapes shapes{std::vector<PatchShape>(patches.count), {}, {}};
  for (const Loop& loop : loops_of(uses, patches)) {
    add_cap(loop, surface.points, shapes.caps);
    shapes.patch_of_cap.resize(shapes.caps.faces.size(), loop.group);
  }
  for (std::size_t i = 0; i < surface.faces.size(); ++i)
    for (const int corner : surface.faces[i])
      shapes.shape[patches.of_face[i]].box.extend(surface.points[corner]);
  for (std::size_t i = 0; i < surface.faces.size(); ++i) {
    PatchShape& shape = shapes.shape[patches.of_face[i]];
    const auto& face = surface.faces[i];
    const double sign = patches.turned[i] ? -1 : 1;
    shape.area += face_area(surface, face);
    shape.area_vector += sign * area_vector(surface, face);
    shape.volume += sign * volume_below(surface, face, shape.box.center());
  }
  for (std::size_t i = 0; i < shapes.caps.faces.size(); ++i) {
    PatchShape& shape = shapes.shape[shapes.patch_of_cap[i]];
    shape.closed = false;
    shape.volume += volume_below(shapes.caps, shapes.caps.faces[i], shape.box.center());
  }
  return shapes;
}

}  // namespace sinew
