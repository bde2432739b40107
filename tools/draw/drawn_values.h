// SPDX-License-Identifier: GPL-3.0-or-later
// The quantities of particles that pictures show in colour: those a run has written, and those that
// are measured from its frames.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "folder/run_files.h"
#include "metrics/body.h"

namespace sinew {

class DrawnValues {
 public:
  /// `name`: an array of the particles, or strain, stretch, J, D2min, von_mises, speed. Throws bad
  /// input for others, with the nearest.
  DrawnValues(const RunFiles& run, const std::string& name);

  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }  ///< empty for pure numbers

  /// One per particle in the written order; of vectors the magnitude. `frame` is the run's frame of
  /// that index.
  std::vector<double> at(std::size_t index, const RunFrame& frame) const;

  /// What stands at the ends of the colours for these values: their range without the hundredth
  /// part at each end, which few stray particles have to themselves; from zero where that is near.
  struct Range {
    double low = 0, high = 0;
  };
  static Range range_of(std::vector<double> values);

 private:
  std::vector<double> measured(const RunFrame& frame) const;

  const RunFiles* run_;
  std::string name_, unit_;
  int components_ = 1;
  std::shared_ptr<const RestBody> rest_;  ///< for what is measured
};

/// An array of vectors at the particles of a frame. Throws bad input when the run has none of that
/// name.
Points drawn_vectors(const RunFiles& run, std::size_t index, const std::string& name);

}  // namespace sinew
