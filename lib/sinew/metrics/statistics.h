// SPDX-License-Identifier: GPL-3.0-or-later
// Count, mean, rms and extremes of many values, in parallel with the same bits for any number of
// threads. Without values they are not-a-number, never zero.
//
//     const Statistics speeds = statistics(n, [&](std::size_t i) { return velocity[i].norm(); });
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <sinew/core/parallel.h>

namespace sinew {

inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

struct Statistics {
  std::size_t count = 0;
  double sum = 0, squares = 0;
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void add(double value) { add(Statistics{1, value, value * value, value, value}); }
  void add(const Statistics& other) {
    count += other.count;
    sum += other.sum;
    squares += other.squares;
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
  double mean() const { return count > 0 ? sum / static_cast<double>(count) : not_measured; }
  double rms() const {
    return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : not_measured;
  }
  double min() const { return count > 0 ? low : not_measured; }
  double max() const { return count > 0 ? high : not_measured; }
};

/// The percentile by nearest rank; values that are not measured do not count. Reorders the values.
inline double percentile(std::vector<double>& values, double percent) {
  const auto end = std::remove_if(values.begin(), values.end(), [](double v) { return v != v; });
  const double count = static_cast<double>(end - values.begin());
  if (count == 0) return not_measured;
  const double rank = std::clamp(std::ceil(percent / 100 * count), 1.0, count);
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
  std::nth_element(values.begin(), place, end);
  return *place;
}

/// Collects value(i) for all i < count; value is called from several threads.
template <class Value>
Statistics statistics(std::size_t count, const Value& value) {
  constexpr std::size_t piece = 1024;
  std::vector<Statistics> parts((count + piece - 1) / piece);
  parallel_for(count, piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) parts[begin / piece].add(value(i));
  });
  Statistics all;  // in the order of the pieces, whichever thread made them
  for (const Statistics& part : parts) all.add(part);
  return all;
}

}  // namespace sinew
