// SPDX-License-Identifier: GPL-3.0-or-later
// The quantities shown in color: those that a run has written, of its particles or of its surface,
// and those measured from its frames.
//
//     const DrawnValues strain(run, "strain");
//     const std::vector<double> of_particles = strain.at(0, frame);
//     const std::vector<double> of_skin = DrawnSkin(run, strain).at(0, frame);
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <sinew/core/dataset.h>
#include <sinew/metrics/rest_body.h>
#include <sinew/rig/skin.h>
#include <sinew/run/run_files.h>

namespace sinew {

class DrawnValues {
 public:
  /// `name`: an array of the particles or the surface, or one that is measured from positions, as
  /// strain (its equivalent), speed, or stress. Throws bad input for other names, suggesting the
  /// nearest, and for stresses that positions do not define.
  DrawnValues(const RunFiles& run, const std::string& name);

  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }  ///< empty for pure numbers
  /// Its name in files: "strain" in pictures is strain_eq there.
  std::string quantity() const { return name_ == "strain" ? "strain_eq" : name_; }
  /// Whether particles have it; else the surface alone.
  bool is_of_particles() const { return of_particles_; }

  /// Values of the particles in the written order; vectors as such. `frame` is the run's frame
  /// `index`. Throws bad input for an array that the frame has not, naming those that it has.
  Column column(std::size_t index, const FrameState& frame) const;
  /// One per particle: the magnitudes of vectors and tensors.
  std::vector<double> at(std::size_t index, const FrameState& frame) const;

 private:
  const RunFiles* run_;
  std::string name_, unit_;
  bool of_particles_ = true;
  std::shared_ptr<const RestBody> rest_;  ///< for what is measured
};

/// The same values at the points of the surface: those that the run has written there, or else
/// means of the particles that move each point, by their weights.
class DrawnSkin {
 public:
  DrawnSkin(const RunFiles& run, const DrawnValues& values);

  std::vector<double> at(std::size_t index, const FrameState& frame) const;

 private:
  Column carried(const Column& of_particles) const;

  const RunFiles* run_;
  DrawnValues values_;
  std::string written_;              ///< the surface's own array; empty: it has none
  Skin skin_;                        ///< else
  std::vector<std::int32_t> place_;  ///< in frames, of the body's particles, -1: not written
};

/// Whether a file of a series has this array of its points.
bool has_array(const RunFiles& run, const PvdRow& row, const std::string& name);

/// A vector array of the particles of a frame. Throws bad input where the run has none so named.
Points drawn_vectors(const RunFiles& run, std::size_t index, const std::string& name);

}  // namespace sinew
