// SPDX-License-Identifier: GPL-3.0-or-later
// Metrics of a run's surface against other surfaces, and of its own folds: what lib/metrics leaves
// to whoever has meshes at hand.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "folder/run_files.h"
#include "metrics/measure.h"

namespace sinew {

/// A series of surfaces that somebody names: frames are taken by their time.
struct SurfaceSeries {
  std::filesystem::path folder;  ///< that its rows lie in
  std::vector<PvdRow> rows;
};

/// Throws bad input, naming the file, for one that is no PVD or has no rows.
SurfaceSeries open_surfaces(const std::filesystem::path& pvd);

/// The frame of these rows at a time (s), within a millionth of a second.
std::optional<std::size_t> frame_at(const std::vector<PvdRow>& rows, double time);

/// The triangles of one frame. Throws bad input, naming the file, where it holds others.
Triangles read_surface_frame(const std::filesystem::path& file);

/// Adds to a frame's metrics: self-intersections, and distances to the rigid pose, to skinning
/// where the run has written it, and to the reference where one is given and has that time.
void add_surface_metrics(FrameMetrics& out, const RunFiles& run, const FrameState& state,
                         const std::optional<SurfaceSeries>& reference);

}  // namespace sinew
