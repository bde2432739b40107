// SPDX-License-Identifier: GPL-3.0-or-later
// The shapes of obstacles as triangles, for pictures.
#pragma once

#include "core/triangles.h"
#include "physics/world/shapes.h"

namespace sinew {

/// Triangles of a shape in its own coordinates, counter-clockwise seen from outside. A plane is a
/// square of edge `size` (m) about its point; spheres and capsules are round to about 1 % of their
/// radius. A mesh gives none: its owner has them.
Triangles surface_of(const Shape& shape, double size);

}  // namespace sinew
