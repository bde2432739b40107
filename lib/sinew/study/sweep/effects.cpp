// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/sweep/effects.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <sinew/core/random.h>

namespace sinew {
namespace {

/// Ranks from 0; equal values share the mean of theirs.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t k = 0; k < order.size();) {
    std::size_t end = k;
    while (end < order.size() && values[order[end]] == values[order[k]]) ++end;
    for (std::size_t n = k; n < end; ++n)
      ranks[order[n]] = (static_cast<double>(k) + static_cast<double>(end) - 1) / 2;
    k = end;
  }
  return ranks;
}

double spearman(const std::vector<double>& x, const std::vector<double>& y) {
  const std::vector<double> a = ranks_of(x), b = ranks_of(y);
  const double mean = (static_cast<double>(a.size()) - 1) / 2;
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    ab += (a[k] - mean) * (b[k] - mean);
    aa += (a[k] - mean) * (a[k] - mean);
    bb += (b[k] - mean) * (b[k] - mean);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : not_measured;
}

}  // namespace

std::vector<LevelMean> level_means(std::span<const std::size_t> level,
                                   std::span<const double> results, std::size_t levels) {
  std::vector<LevelMean> means(levels);
  for (std::size_t k = 0; k < level.size(); ++k) {
    if (!std::isfinite(results[k])) continue;
    LevelMean& one = means[level[k]];
    one.mean = (one.runs == 0 ? 0 : one.mean) + results[k];
    ++one.runs;
  }
  for (LevelMean& one : means)
    if (one.runs > 0) one.mean /= static_cast<double>(one.runs);
  return means;
}

double main_effect(std::span<const LevelMean> means) {
  double low = not_measured, high = not_measured;
  std::size_t count = 0;
  for (const LevelMean& one : means) {
    if (one.runs == 0) continue;
    low = count == 0 ? one.mean : std::min(low, one.mean);
    high = count == 0 ? one.mean : std::max(high, one.mean);
    ++count;
  }
  return count < 2 ? not_measured : high - low;
}

RankCorrelation rank_correlation(std::span<const double> x, std::span<const double> y) {
  constexpr int resamples = 400;
  std::vector<double> a, b;
  for (std::size_t k = 0; k < x.size(); ++k)
    if (std::isfinite(x[k]) && std::isfinite(y[k])) a.push_back(x[k]), b.push_back(y[k]);
  RankCorrelation found;
  if (a.size() < min_correlated) return found;
  found.value = spearman(a, b);
  if (std::isnan(found.value)) return found;
  Random random(1);
  double sum = 0, squares = 0;
  int count = 0;
  std::vector<double> c(a.size()), d(a.size());
  for (int n = 0; n < resamples; ++n) {
    for (std::size_t k = 0; k < a.size(); ++k) {
      const std::size_t from = random.next() % a.size();
      c[k] = a[from], d[k] = b[from];
    }
    const double value = spearman(c, d);
    if (std::isnan(value)) continue;  // the same pair each time
    sum += value, squares += value * value, ++count;
  }
  if (count > 1)
    found.error = std::sqrt(std::max(0.0, (squares - sum * sum / count) / (count - 1)));
  return found;
}

}  // namespace sinew
