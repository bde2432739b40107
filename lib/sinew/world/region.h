// SPDX-License-Identifier: GPL-3.0-or-later
// A part of space, with a smooth edge if wanted, and a number that changes over time.
//
//     const double weight = region.weight(point), strength = keys.at(time);
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sinew/world/shapes.h>

namespace sinew {

struct Region {
  std::optional<Shape> shape;  ///< none: everywhere
  double falloff = 0;          ///< width of the edge outside the shape, m

  /// 1 in the shape and on its surface, falling smoothly (3 s^2 - 2 s^3) to 0 at `falloff` from it.
  double weight(const Vec3& point) const;
};

/// Throws bad input for a bad shape or a falloff that is negative or not finite.
void check_region(const Region& region, const std::string& what);

// Linear between keys; constant before the first and after the last.

struct KeyedValue {
  std::vector<double> times;   ///< s, strictly ascending
  std::vector<double> values;  ///< one per time

  double at(double time) const;  ///< 1 without keys
  /// Change per second, 1/s; at a key, that of the interval after it.
  double rate(double time) const;
  double largest() const;  ///< largest magnitude over all time
};

struct KeyedPlace {
  std::vector<double> times;  ///< s, strictly ascending
  std::vector<Vec3> places;   ///< one per time, m

  Vec3 at(double time) const;  ///< the origin without keys
};

/// Throws bad input, which names `what` the keys are for, unless there is one value per time, all
/// are finite, times ascend and values lie in [low, high].
void check_keys(const KeyedValue& keys, double low, double high, const std::string& what);

}  // namespace sinew
