// SPDX-License-Identifier: GPL-3.0-or-later
// What holds for the polygons of every mesh that a reader lets pass.
#pragma once

#include <cmath>

#include <sinew/core/surface_look.h>
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

/// Corners of a look are -1 or count from 0 (whether they exist is checked when they are used).
inline void require_sound(const PolygonSoup& soup, const PolygonLook& file) {
  const SurfaceLook& look = file.look;
  require(look.part.size() == soup.polygons.size());
  for (const int part : look.part)
    require(part >= -1 && part < static_cast<int>(look.parts.size()));
  for (const auto* corners : {&file.corners, &file.normal_corners, &file.layer_corners}) {
    if (corners->empty()) continue;
    require(corners->size() == soup.polygons.size());
    for (std::size_t i = 0; i < corners->size(); ++i) {
      require((*corners)[i].size() == soup.polygons[i].size());
      for (const int corner : (*corners)[i]) require(corner >= -1);
    }
  }
  for (const auto& [u, v] : look.coordinates) require(std::isfinite(u) && std::isfinite(v));
  for (const Vec3& normal : look.normals) require(normal.allFinite());
}

}  // namespace sinew::fuzz
