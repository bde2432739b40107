// SPDX-License-Identifier: GPL-3.0-or-later
// What holds for the polygons of every mesh that a reader lets pass.
#pragma once

#include <sinew/core/triangles.h>
#include "targets.h"

namespace sinew::fuzz {

inline void require_sound(const PolygonSoup& soup) {
  for (const Vec3& point : soup.points) require(point.allFinite());
  for (const auto& polygon : soup.polygons) {
    require(polygon.size() >= 3);
    for (const int corner : polygon)
      require(corner >= 0 && corner < static_cast<int>(soup.points.size()));
  }
}

}  // namespace sinew::fuzz
