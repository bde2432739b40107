// SPDX-License-Identifier: GPL-3.0-or-later
// The distance between two surfaces of any triangulation.
//
//     const double gap = surface_gap(one, other).hausdorff;
#pragma once

#include <sinew/core/triangles.h>
#include <sinew/mesh/face_tree.h>

namespace sinew {

struct SurfaceGap {
  double hausdorff = 0;  ///< largest distance of a point on either from the other, m
  double mean = 0;       ///< over the area of both, m
};

/// Both are sampled at the corners and centers of all faces, so that the Hausdorff distance may be
/// underestimated between them (not for flat pieces; for a face across a fold of the other by at
/// most half its longest edge); the mean is by Simpson's rule over each face. Two states of one
/// mesh are fastest. In parallel, the same bits for any number of threads. Throws bad input for a
/// surface without area.
SurfaceGap surface_gap(const FaceTree& one, const FaceTree& other);
SurfaceGap surface_gap(const Triangles& one, const Triangles& other);

}  // namespace sinew
