// SPDX-License-Identifier: GPL-3.0-or-later
// The limit of a quantity as particles become small, from runs with particles of several sizes.
//
//     const ContinuumLimit limit = continuum_limit(radii, deflections);
//     // limit.value +- limit.error
#pragma once

#include <span>
#include <vector>

#include <sinew/core/value_range.h>
#include <sinew/metrics/statistics.h>

namespace sinew {

/// Not-a-number throughout where a value is, with fewer than two sizes, and where the values do not
/// approach one.
struct ContinuumLimit {
  double value = not_measured;  ///< at size 0
  double error = not_measured;  ///< error of it: an estimate, not a bound
  /// Values differ from the limit by size^order; of a parabola, by the three smallest sizes.
  /// Not-a-number where the values tell none.
  double order = not_measured;
};

/// Finds the limit of values at sizes above 0, all different, in any order.
///
/// A body of particles differs from its continuum by a term of its surface, of the first order, and
/// by terms of the second: the limit is that of a parabola. How well the layers of a packing fit
/// the mesh differs from size to size, so values may also scatter. Of four or more that a parabola
/// fits hardly better than one of the two terms alone, the limit is the mean of those of both, each
/// weighted by how well it fits (Akaike's weights, doi 10.1109/TAC.1974.1100705; from six sizes on,
/// the parabola is the third), and the order is that of the term that outweighs the other.
///
/// Nine of ten limits of values that scatter are within the error, which includes how far the terms
/// disagree. That of a parabola is at least the distance from the limit of the better term; of
/// three sizes, from those of a line, of the line through the smaller two, and of the extrapolation
/// by the order (Roache's, doi 10.1115/1.2910291) where it is between 1/2 and 3.
///
/// Values do not approach one where the error exceeds the largest of them; and where it exceeds a
/// fifth of it, and the limit lies farther from the finest value than twice as far as a term of the
/// first order takes what the values differ by.
ContinuumLimit continuum_limit(std::span<const double> sizes, std::span<const double> values);

/// The limit of a quantity that lies in a range: its end where the error reaches that, else none.
ContinuumLimit within(const ContinuumLimit& limit, const ValueRange& range);

/// The value of each run that is farthest to one side, with its sign: to the side on which the runs
/// together go farther from zero, lest it jumps between extremes of almost the same size.
/// Not-a-number for a run without values.
std::vector<double> largest_of_one_sign(std::span<const std::vector<double>> runs);

}  // namespace sinew
