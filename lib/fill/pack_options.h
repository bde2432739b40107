// SPDX-License-Identifier: GPL-3.0-or-later
// How a surface is to be filled.
#pragma once

#include <optional>

#include "core/settings.h"

namespace sinew {

struct PackOptions {
  Packing packing = Packing::fcc;
  std::optional<double> radius;          ///< m; either this
  std::optional<int> count;              ///< or about so many particles
  double density = 1000;                 ///< kg/m^3
  std::optional<Vec3> lattice_origin;    ///< where a site lies, m; by default in the box's middle
  Mat3 lattice_axes = Mat3::Identity();  ///< as columns: a rotation
  Keep keep = Keep::centre;
  double clearance = 0;             ///< how far within, m
  std::optional<double> thickness;  ///< fill a layer along the surface instead of its inside, m
  bool verify = false;              ///< ask CGAL about every site
};

}  // namespace sinew
