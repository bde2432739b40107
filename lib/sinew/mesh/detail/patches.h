// SPDX-License-Identifier: GPL-3.0-or-later
// Patches: faces joined across edges of exactly two faces. The orientation of one face determines
// that of its whole patch.
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include <sinew/mesh/border.h>

namespace sinew {

struct Patches {
  std::vector<int> of_face;  ///< patch of each face; patches are numbered by their first face
  std::vector<bool> turned;  ///< faces to reverse for a patch to be oriented as most of its area
  int count = 0;
  std::size_t twisted_edges = 0;  ///< whose two faces cannot agree: the patch is cut there
};

/// Searches the faces breadth-first, so that the cuts are short.
Patches patches_of(const Triangles& surface, std::span<const EdgeUse> uses);

/// Calls visit(patch, count) for each patch that traverses the edge of these uses more often in one
/// direction than in the other: count is positive from the low to the high point.
template <class Visit>
void for_each_border(std::span<const EdgeUse> use, const Patches& patches, Visit&& visit) {
  std::vector<std::pair<int, int>> counts;
  for (const EdgeUse& side : use)
    counts.emplace_back(patches.of_face[side.face],
                        side.forward != patches.turned[side.face] ? 1 : -1);
  std::sort(counts.begin(), counts.end());
  for (std::size_t i = 0; i < counts.size();) {
    const int patch = counts[i].first;
    int count = 0;
    for (; i < counts.size() && counts[i].first == patch; ++i) count += counts[i].second;
    if (count != 0) visit(patch, count);
  }
}

/// Faces joined by edges of any number of faces.
struct Components {
  std::vector<int> of_face;  ///< numbered by their first face
  int count = 0;
};

Components components_of(const Patches& patches, std::span<const EdgeUse> uses);

// The volumes that patches enclose once their holes are capped.

struct PatchShape {
  Box box;
  bool closed = true;
  double area = 0;                  ///< m^2
  Vec3 area_vector = Vec3::Zero();  ///< sum of area times normal, m^2: 0 for closed patches
  double volume = 0;  ///< with its caps, oriented as most of its area in the file, m^3

  /// Whether the sign of the volume decides which side is outside. For closed patches: unless it is
  /// a rounding error. For open ones: where the patch bends around it (a sheet has an area vector
  /// as long as its area, a hemisphere half as long) and is not a thin film.
  bool decides() const;
};

struct PatchShapes {
  std::vector<PatchShape> shape;  ///< per patch
  Triangles caps;
  std::vector<int> patch_of_cap;  ///< per face of the caps
};

PatchShapes shapes_of(const Triangles& surface, std::span<const EdgeUse> uses,
                      const Patches& patches);

}  // namespace sinew
