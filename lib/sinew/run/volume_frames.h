// SPDX-License-Identifier: GPL-3.0-or-later
// The frames of the series `volume`: cells between the particles of a frame, while a run writes
// them or afterwards.
//
//     const VolumeFrames volume(cells_of_body(settings, surface, rest, r), rest, r, skeleton,
//     bound); series.add(volume.at(particles, volume.apart_beyond(particles.points, b)));
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <sinew/core/dataset.h>
#include <sinew/rig/binding.h>
#include <sinew/rig/skeleton.h>
#include <sinew/run/run_files.h>
#include <sinew/scene/prepare.h>
#include <sinew/volume/moving_cells.h>

namespace sinew {

using ParticlePair = std::array<std::uint32_t, 2>;

class VolumeFrames {
 public:
  /// The frames of particles at `rest` (m, by id) with `radius` (m).
  VolumeFrames(VolumeCells cells, const Points& rest, double radius, const Skeleton& skeleton,
               const Binding& binding)
      : cells_(std::move(cells), rest, radius, skeleton, binding) {}

  /// Pairs that may be bonds; each is apart or not.
  const std::vector<ParticlePair>& pairs() const { return cells_.pairs(); }
  /// Pairs that touch at rest and are farther apart than `range` (m).
  std::vector<char> apart_beyond(const Points& positions, double range) const;
  std::size_t cells() const { return cells_.rest().cells.size(); }

  /// `particles`: a frame of all of them, without computed columns.
  Dataset at(const Dataset& particles, const std::vector<char>& apart) const;

 private:
  MovingCells cells_;
};

/// Whether each pair is among these, which are ascending.
std::vector<char> apart_if_broken(std::span<const ParticlePair> pairs,
                                  std::span<const ParticlePair> broken);

/// The numbers that Float32 keeps of a frame of particles of `radius` (m): what a file has of it.
Dataset in_single_precision(Dataset particles, double radius);

/// The cells of a scene's body, where it asks for them (output.volume).
std::optional<VolumeCells> cells_to_write(const Prepared& prepared);
/// A warning where cells hold clearly less than a body of that density (kg/m^3).
std::optional<std::string> lost_by_cells(const VolumeCells& cells, const Particles& particles,
                                         double density, const Surface& surface);

/// The cells of a run's body in its frames. Of bonds that may break, those count as broken that the
/// run has written so, or else the longest ones of particles that have lost some.
class RunVolume {
 public:
  /// The run must outlive this object. Throws bad input for a run that has not written all
  /// particles, or whose mesh has changed.
  explicit RunVolume(const RunFiles& run);

  std::size_t cells() const { return frames_.cells(); }
  /// A warning where they hold clearly less than the body.
  const std::optional<std::string>& warning() const { return warning_; }
  /// `particles`: all of them in frame `index`, with `broken_bonds` where the run has written it.
  Dataset at(std::size_t index, const Dataset& particles) const;

 private:
  const RunFiles* run_;
  std::optional<std::string> warning_;
  VolumeFrames frames_;
};

struct ExportedVolume {
  std::size_t frames = 0, cells = 0;
  std::filesystem::path pvd;
  std::optional<std::string> warning;  ///< see RunVolume::warning()
};

/// Writes these frames of a run as the series `volume` in `folder`, as the run itself does with
/// output.volume. Throws as RunVolume does, and not written.
ExportedVolume export_volume(const RunFiles& run, const std::vector<std::size_t>& frames,
                             const std::filesystem::path& folder);

}  // namespace sinew
