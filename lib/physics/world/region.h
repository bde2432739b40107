// SPDX-License-Identifier: GPL-3.0-or-later
// A part of space, with a soft edge if wanted.
#pragma once

#include <optional>
#include <string>

#include "physics/world/shapes.h"

namespace sinew {

struct Region {
  std::optional<Shape> shape;  ///< none: everywhere
  double falloff = 0;          ///< width of the edge outside the shape, m

  /// 1 in the shape and on its surface, falling smoothly (3 s^2 - 2 s^3) to 0 at `falloff` from it.
  double weight(const Vec3& point) const;
};

/// Throws bad input for a bad shape or a falloff that is negative or not finite.
void check_region(const Region& region, const std::string& what);

}  // namespace sinew
