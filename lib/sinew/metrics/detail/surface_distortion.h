// SPDX-License-Identifier: GPL-3.0-or-later
// The distortion of a skin: stretch of its edges and faces, and the number of flipped faces.
//
//     const SurfaceDistortion distortion = surface_distortion(rest.surface, state.surface_points);
#pragma once

#include <sinew/core/triangles.h>

namespace sinew {

/// Not-a-number where no face or edge has a size at rest.
struct SurfaceDistortion {
  double area = 0;      ///< m^2
  double edge_stretch;  ///< max of l / l0 and l0 / l over the edges
  double area_stretch;  ///< max of A / A0 and A0 / A over the faces
  double conformal;     ///< max of s1 / s2, the two stretches of a face; 1: angles are kept
  double dirichlet;     ///< mean over A0 of s1^2 + s2^2 + 1/s1^2 + 1/s2^2; 4 when rigid
  double flipped;       ///< faces opposed to the mean normals at their corners
};

/// Compares `now` (points in the order of rest.points, m) with the surface at rest. In parallel.
SurfaceDistortion surface_distortion(const Triangles& rest, const Points& now);

/// The stretches of a triangle that moved from one to the other corners, larger first; infinite or
/// not-a-number for one without area at rest.
std::array<double, 2> face_stretches(const std::array<Vec3, 3>& rest,
                                     const std::array<Vec3, 3>& now);

}  // namespace sinew
