// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cleaning/orient.h"

#include "mesh/cleaning/cavities.h"
#include "mesh/cleaning/patch_shapes.h"
#include "mesh/measures.h"

namespace sinew {
namespace {

/// Whether the faces as a whole enclose less than nothing.
bool inside_out(const Triangles& surface, const Patches& patches) {
  const Box box = bounds(surface.points);
  double volume = 0;
  for (std::size_t i = 0; i < surface.faces.size(); ++i)
    volume += (patches.turned[i] ? -1 : 1) * volume_below(surface, surface.faces[i], box.center());
  return volume < -volume_rounding(area(surface), box);
}

/// Of patches that decide, the area of those that turn less that of those that stay.
struct Vote {
  bool cast = false;
  double excess = 0;

  void add(bool turns, double area) {
    cast = true;
    excess += turns ? area : -area;
  }
};

/// Lets patches that do not decide follow.
void follow(std::vector<bool>& turn, const Triangles& surface, const Patches& patches,
            const PatchShapes& shapes, const Components& components) {
  std::vector<int> component(patches.count);
  for (std::size_t i = 0; i < patches.of_face.size(); ++i)
    component[patches.of_face[i]] = components.of_face[i];
  Vote all;
  std::vector<Vote> vote(components.count);
  for (int patch = 0; patch < patches.count; ++patch) {
    if (!shapes.shape[patch].decides()) continue;
    all.add(turn[patch], shapes.shape[patch].area);
    vote[component[patch]].add(turn[patch], shapes.shape[patch].area);
  }
  const bool otherwise = all.cast ? all.excess > 0 : inside_out(surface, patches);
  for (int patch = 0; patch < patches.count; ++patch) {
    const Vote& nearby = vote[component[patch]];
    if (!shapes.shape[patch].decides()) turn[patch] = nearby.cast ? nearby.excess > 0 : otherwise;
  }
}

}  // namespace

std::vector<bool> faces_to_turn(const Triangles& surface, std::span<const EdgeUse> uses,
                                const Patches& patches, const Components& components,
                                FillRule rule) {
  const PatchShapes shapes = shapes_of(surface, uses, patches);
  const std::vector<bool> cavity = cavities_of(surface, patches, shapes, rule);
  std::vector<bool> turn(patches.count);
  for (int patch = 0; patch < patches.count; ++patch)
    turn[patch] = (shapes.shape[patch].volume < 0) != cavity[patch];
  follow(turn, surface, patches, shapes, components);

  std::vector<bool> turned(surface.faces.size());
  for (std::size_t i = 0; i < turned.size(); ++i)
    turned[i] = patches.turned[i] != turn[patches.of_face[i]];
  return turned;
}

}  // namespace sinew
