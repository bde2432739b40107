// SPDX-License-Identifier: GPL-3.0-or-later
// How a result depends on what varies: means by value, and correlations of ranks.
//
//     const RankCorrelation found = rank_correlation(moduli, errors);
//     // found.value +- found.error
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <sinew/metrics/statistics.h>

namespace sinew {

/// Mean of a result over the runs with one value.
struct LevelMean {
  double mean = not_measured;
  std::size_t runs = 0;
};

/// The mean for each of `levels` values, where run k has value level[k]. Runs without a result do
/// not count.
std::vector<LevelMean> level_means(std::span<const std::size_t> level,
                                   std::span<const double> results, std::size_t levels);

/// The largest of the means less the smallest: the main effect. Not-a-number with fewer than two.
double main_effect(std::span<const LevelMean> means);

struct RankCorrelation {
  double value = not_measured;  ///< -1 to 1
  double error = not_measured;  ///< standard error
};

/// Fewest samples that tell a correlation.
inline constexpr std::size_t min_correlated = 10;

/// Spearman's coefficient of pairs that are both finite, with mean ranks of equal values; its error
/// is the standard deviation over 400 bootstrap samples (Efron 1979, doi 10.1214/aos/1176344552),
/// the same on every machine. Not-a-number with fewer than min_correlated pairs, and where one of
/// the two never varies.
RankCorrelation rank_correlation(std::span<const double> x, std::span<const double> y);

}  // namespace sinew
