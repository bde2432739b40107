// SPDX-License-Identifier: GPL-3.0-or-later
// The least-squares deformation gradient of a cloud of points over its neighbors at rest: F = (sum
// dx dX^T) (sum dX dX^T)^-1. Exact for affine motion.
//
//     const RestShape rest = rest_shape(points, range);
//     const Mat3 F = deformation_gradient(rest, now, i);
#pragma once

#include <sinew/core/cell_grid.h>
#include <sinew/core/vector.h>

namespace sinew {

/// Determined once by the rest state: neighbors and the inverse of sum dX dX^T for each point.
struct RestShape {
  Points points;              ///< n x 3, m
  NeighborLists neighbors;    ///< pairs at rest closer than the range given
  std::vector<Mat3> inverse;  ///< (sum dX dX^T)^-1, 1/m^2; zero where the neighbors lie in a plane

  /// Whether point i has enough neighbors (not all in one plane) to define a gradient.
  bool defined(std::size_t i) const { return !inverse[i].isZero(0); }
};

/// The rest shape of `points` (m) with their neighbors. In parallel.
RestShape rest_shape(Points points, NeighborLists neighbors);
/// The same with pairs closer than `range` (m) as neighbors.
RestShape rest_shape(Points points, double range);

/// sum dx dX^T over the neighbors of point i (m^2): the only information where F is undefined.
Mat3 moved_spread(const RestShape& rest, const Points& now, std::size_t i);

/// F of point i when the points have moved to `now` (n x 3, m); identity where it is undefined.
Mat3 deformation_gradient(const RestShape& rest, const Points& now, std::size_t i);

/// Mean |dx - F dX|^2 over the neighbors of point i at rest (m^2): motion that F does not explain.
/// D2min of Falk and Langer (1998) is the sum.
double non_affine(const RestShape& rest, const Points& now, const Mat3& F, std::size_t i);

/// The affine motion of a point's neighborhood, and what it leaves.
struct AffineFit {
  Mat3 F;
  double D2min;  ///< mean |dx - F dX|^2, m^2
};

/// The same of points some of which may be gone: not-a-number in `now`, and no one's neighbors. A
/// second pass, over what the first F leaves, is exact to rounding for neighborhoods of any shape.
/// Not-a-number where it is undefined.
AffineFit affine_fit(const RestShape& rest, const Points& now, std::size_t i);

/// The rotation R of the polar decomposition F = R U; proper (det R = 1) for inverted F as well,
/// and the shortest one where F keeps only a line.
Mat3 rotation_part(const Mat3& F);

}  // namespace sinew
