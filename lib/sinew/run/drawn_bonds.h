// SPDX-License-Identifier: GPL-3.0-or-later
// The bonds of a run's frames as lines to be drawn, in the colors of one of their quantities.
//
//     const DrawnBonds bonds(run, "strain");
//     for (const DrawnBond& bond : bonds.at(0)) lines.push_back({bond.from, bond.to, bond.value});
#pragma once

#include <array>
#include <string>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/run/run_files.h>

namespace sinew {

struct DrawnBond {
  std::array<int, 2> ends{};                    ///< particles in the written order
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< m
  double value = 0;                             ///< value of the quantity
};

class DrawnBonds {
 public:
  /// `name`: strain, length or force. Throws bad input for another one, and for a run that has not
  /// written its bonds.
  DrawnBonds(const RunFiles& run, const std::string& name);

  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }  ///< empty for pure numbers

  /// Reads bonds of frame `index` that are not broken. Throws bad input, naming the file, where it
  /// is damaged or of another body.
  std::vector<DrawnBond> at(std::size_t index) const;

 private:
  const RunFiles* run_;
  std::string name_, unit_;
};

}  // namespace sinew
