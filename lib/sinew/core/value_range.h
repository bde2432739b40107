// SPDX-License-Identifier: GPL-3.0-or-later
// The range of a quantity that colors stand for, found in one pass over all frames of a run.
//
//     RangeFinder finder;
//     for (const auto& values : frames) finder.add(values);
//     const ValueRange range = finder.range();
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sinew {

struct ValueRange {
  double low = 0, high = 0;
};

/// "LOW,HIGH" of a command, as numbers. Throws bad input for others than two, the lower one first.
ValueRange color_range(std::span<const double> numbers);

/// Ranges of quantities by the names of their arrays.
using ValueRanges = std::map<std::string, ValueRange>;

/// The name under which the range of an array stands: a velocity's size is the speed.
std::string quantity_of(const std::string& array);

/// Fraction of all values of a run that lies beyond either end of a range: a few particles that
/// have escaped do not determine the colors of all others.
inline constexpr double beyond_range = 0.005;

/// Counts values by their leading 20 bits as single-precision numbers, so that the ends of a range
/// are right to 1 in 4,000 and memory does not grow with the run.
class RangeFinder {
 public:
  /// Values that are not finite do not count.
  void add(std::span<const double> values);
  void add(std::span<const float> values);
  bool empty() const { return count_ == 0; }
  /// The 0.5th and the 99.5th percentile; zero for the lower one where it is near and nothing is
  /// negative. Zeros where there are no values.
  ValueRange range() const;

 private:
  using Page = std::array<std::uint64_t, 256>;

  void add(float value);
  double at_rank(std::uint64_t rank) const;

  std::vector<std::unique_ptr<Page>> pages_;
  std::uint64_t count_ = 0;
  float min_ = std::numeric_limits<float>::infinity(), max_ = -min_;
};

}  // namespace sinew
