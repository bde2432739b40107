// SPDX-License-Identifier: GPL-3.0-or-later
// How far two surfaces lie apart, whatever their points and triangles are.
#pragma once

#include "core/triangles.h"

namespace sinew {

struct SurfaceGap {
  double hausdorff = 0;  ///< the farthest that a place on either lies from the other, m
  double mean = 0;       ///< over the area of both, m
};

/// Both are looked at in the corners and the centres of all faces, so that the Hausdorff distance
/// may be short by what happens between them (of two flat pieces nothing, of a face across a fold
/// of the other at most half its longest edge); the mean is Simpson's over each face. In parallel,
/// the same bits for any number of threads. Throws bad input for a surface without an area.
SurfaceGap surface_gap(const Triangles& one, const Triangles& other);

}  // namespace sinew
