// SPDX-License-Identifier: GPL-3.0-or-later
// What patches enclose once their holes are capped.
#pragma once

#include "mesh/cleaning/patches.h"

namespace sinew {

struct PatchShape {
  Box box;
  bool closed = true;
  double area = 0;                  ///< m^2
  Vec3 area_vector = Vec3::Zero();  ///< sum of area times normal, m^2: 0 for closed patches
  double volume = 0;                ///< with its caps, as most of its area turns in the file, m^3

  /// Whether the sign of the volume tells the outside. For closed patches: unless it is a rounding
  /// error. For open ones: when the patch bends around it (a sheet has an area vector as long as
  /// its area, a hemisphere half as long) and it is no film.
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
