// SPDX-License-Identifier: GPL-3.0-or-later
// A number that changes over time: straight lines between keys, the first and last value held
// before and after them.
#pragma once

#include <string>
#include <vector>

namespace sinew {

struct KeyedValue {
  std::vector<double> times;   ///< s, strictly ascending
  std::vector<double> values;  ///< one per time

  double at(double time) const;  ///< 1 without keys
  /// Change per second, 1/s; at a key that of the line after it.
  double rate(double time) const;
  double largest() const;  ///< of the magnitudes over all time
};

/// Throws bad input, naming `what` the keys are for, unless there is one value per time, all are
/// finite, times ascend and values lie in [low, high].
void check_keys(const KeyedValue& keys, double low, double high, const std::string& what);

}  // namespace sinew
