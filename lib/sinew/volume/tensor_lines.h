// SPDX-License-Identifier: GPL-3.0-or-later
// Lines along the largest principal value of a tensor field in tetrahedra, such as the largest
// principal stress: how a body carries its loads. At each place a line has the direction of that
// eigenvector of the interpolated tensor (tensor field lines: Dickinson 1989; hyperstreamlines:
// Delmarcelle and Hesselink 1993). Lines keep a distance from each other (Jobard and Lefer 1997).
//
//     const std::vector<TensorLine> lines = tensor_lines(points, cells, stress, {.spacing = 0.02});
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/volume/volume_cells.h>

namespace sinew {

/// A symmetric tensor: XX YY ZZ XY YZ XZ.
using SymmetricTensor = std::array<double, 6>;

/// The largest principal value, and its direction, of either sign.
struct LargestPrincipal {
  double value = 0;
  Vec3 direction = Vec3::UnitX();
};
LargestPrincipal largest_principal(const SymmetricTensor& tensor);

struct TensorLine {
  Points points;               ///< n x 3, m
  std::vector<double> values;  ///< the largest principal value there
};

struct TensorLineOptions {
  double spacing = 0;             ///< lines begin this far from others, and end at half of it, m
  double min_value = 0;           ///< where the largest principal value is smaller, lines end
  std::size_t max_lines = 200;    ///< lines with the largest values come first
  std::size_t max_points = 4000;  ///< limit for each line
};

/// `tensors`: one per point; lines end where one is not finite, and at the border of the cells.
/// Lines shorter than the spacing are left out. Throws bad input without a positive spacing.
std::vector<TensorLine> tensor_lines(const Points& points, std::span<const Cell> cells,
                                     const std::vector<SymmetricTensor>& tensors,
                                     const TensorLineOptions& options);

}  // namespace sinew
