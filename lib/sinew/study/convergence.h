// SPDX-License-Identifier: GPL-3.0-or-later
// The limit of a quantity as particles become small, from runs with particles of several sizes.
//
//     const ContinuumLimit limit = continuum_limit(radii, deflections);  // limit.value +-
//     limit.error
#pragma once

#include <span>

#include <sinew/metrics/statistics.h>

namespace sinew {

/// Not-a-number throughout where a value is, or with fewer than two sizes.
struct ContinuumLimit {
  double value = not_measured;  ///< at size 0
  double error = not_measured;  ///< of it: an estimate, not a bound
  /// Of the error, by the three smallest sizes: values differ from the limit by size^order.
  /// Not-a-number where they do not approach a limit from one side.
  double order = not_measured;
};

/// Of values at sizes above 0, all different, in any order.
///
/// A body of particles differs from its continuum by a term of its surface, of the first order, and
/// by terms of the second: the limit is that of a parabola. How well the layers of a packing fit
/// the mesh differs from size to size, so values may also scatter: of four or more that a parabola
/// fits hardly better than a line, the limit is that of the line, and there is no order.
///
/// The error is the largest of: twice the standard error of the limit by the residuals; of a
/// parabola, the distance from the limit of a line; of three sizes, those from the line through the
/// smaller two, and from the extrapolation by the order (Roache's, doi 10.1115/1.2910291) where it
/// is between 1/2 and 3.
ContinuumLimit continuum_limit(std::span<const double> sizes, std::span<const double> values);

}  // namespace sinew
