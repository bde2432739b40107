// SPDX-License-Identifier: GPL-3.0-or-later
// What parts of a body have beside their modulus that its material has not.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace sinew {

/// Values by particle id; each list is empty where all of the body is as its material says.
struct LocalStrength {
  std::vector<double> volume = {};    ///< K_v against its change of volume, Pa
  std::vector<double> breaking = {};  ///< strain at which bonds break; of two parts the smaller
  std::vector<double> yield = {};     ///< shear beyond which bonds creep

  bool empty() const { return volume.empty() && breaking.empty() && yield.empty(); }
};

/// A breaking strain and a yield shear that no bond reaches.
inline constexpr double never_reached = 1e9;

/// Returns the value of one particle; `common`: the material's.
inline double value_at(const std::vector<double>& local, std::size_t id, double common) {
  return local.empty() ? common : local[id];
}

/// The largest of a body.
inline double largest_of(const std::vector<double>& local, double common) {
  return local.empty() ? common : *std::max_element(local.begin(), local.end());
}

}  // namespace sinew
