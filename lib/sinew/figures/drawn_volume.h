// SPDX-License-Identifier: GPL-3.0-or-later
// The body's volume in pictures: cut by a plane, or filled with lines of stress.
//
//     const DrawnVolume volume(run);
//     snapshot.cut = volume.cut(index, frame, values, plane.at(frame));
#pragma once

#include <vector>

#include <sinew/core/dataset.h>
#include <sinew/figures/drawn_plane.h>
#include <sinew/render/snapshot.h>
#include <sinew/run/run_files.h>
#include <sinew/run/volume_frames.h>

namespace sinew {

class DrawnVolume {
 public:
  /// Throws as RunVolume does.
  explicit DrawnVolume(const RunFiles& run) : run_(&run), volume_(run) {}

  /// A body cut open, and the particles in the holes that torn cells leave.
  struct Opened {
    SnapshotCut cut;
    std::vector<bool> in_hole;  ///< one per particle
  };
  /// The cells that the plane crosses in the run's frame `index`, without torn ones. `values`: one
  /// per particle.
  Opened cut(std::size_t index, const FrameState& frame, std::vector<double> values,
             const CutPlane& plane) const;

  /// Lines along the largest principal value of a symmetric tensor of the particles, where it
  /// exceeds `min_value`.
  std::vector<SnapshotCurve> lines(std::size_t index, const FrameState& frame, const Column& tensor,
                                   double min_value) const;

 private:
  Dataset cells(std::size_t index, const FrameState& frame, Column column) const;

  const RunFiles* run_;
  RunVolume volume_;
};

/// The largest principal value of each row of a symmetric tensor, XX YY ZZ XY YZ XZ.
std::vector<double> largest_principals(const Column& tensor);

}  // namespace sinew
