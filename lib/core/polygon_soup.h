// SPDX-License-Identifier: GPL-3.0-or-later
// What a mesh file holds before anyone has looked at it: points, and polygons over them.
#pragma once

#include <vector>

#include "core/vector.h"

namespace sinew {

struct PolygonSoup {
  Points points;                           ///< n x 3, m
  std::vector<std::vector<int>> polygons;  ///< any number of corners each, indices into points
};

}  // namespace sinew
