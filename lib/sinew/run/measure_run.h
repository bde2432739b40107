// SPDX-License-Identifier: GPL-3.0-or-later
// Measures a run frame by frame: all metrics, their summary and the checks of limits.
//
//     const Measured measured = measure_run(open_run({"out/bend"}), {});
//     write_file("metrics.csv", metrics_csv(measured.frames));
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include <sinew/core/arrays.h>
#include <sinew/metrics/bone_metrics.h>
#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/limits.h>
#include <sinew/metrics/report/playback.h>
#include <sinew/metrics/sections.h>
#include <sinew/metrics/summary.h>
#include <sinew/run/run_files.h>

namespace sinew {

// Metrics that compare a run's surface with other surfaces, and its self-intersections:
// <sinew/metrics> does not depend on meshes.

/// A series of reference surfaces; frames are selected by their time.
struct SurfaceSeries {
  std::filesystem::path folder;  ///< folder of the paths in its rows
  std::vector<PvdRow> rows;
};

/// Throws bad input, naming the file, where it is not a PVD, has no rows or several of one time.
SurfaceSeries open_surfaces(const std::filesystem::path& pvd);

/// The frame of these rows at a time (s), within a millionth of a second.
std::optional<std::size_t> frame_at(const std::vector<PvdRow>& rows, double time);

/// The triangles of one frame. Throws bad input, naming the file, where it holds other cells.
Triangles read_surface_frame(const std::filesystem::path& file);

/// Adds to a frame's metrics: self-intersections, and the distances to the rigid pose, to the
/// skinned surfaces if the run has written them, and to the reference if it has a frame of that
/// time. `at_rest`: pairs of faces that intersect at rest, which do not count.
void add_surface_metrics(FrameMetrics& out, const RunFiles& run, const FrameState& state,
                         const std::optional<SurfaceSeries>& reference, std::size_t at_rest = 0);

struct Measured {
  std::vector<FrameMetrics> frames;
  Summary summary;
  std::vector<Check> checks;
  Playback playback;
  ValueRanges ranges;                    ///< ranges of the playback's fields
  std::vector<BoneMetrics> bones;        ///< rows of every frame
  std::vector<SectionMetrics> sections;  ///< rows of every frame
};

struct MeasureOptions {
  std::vector<Limit> limits;
  std::optional<SurfaceSeries> reference;
  RequestedArrays arrays;  ///< to be written as the series "values"
  bool ahead = true;       ///< read the next frame while one is measured
  bool playback = true;    ///< make one
  std::function<void(std::size_t done, std::size_t of)> progress = {};  ///< after each frame
};

/// The body of a run at rest; `first`: its first frame.
RestBody rest_of(const RunFiles& run, const FrameState& first);
RestBody rest_of(const RunFiles& run);

/// Holds two frames in memory at a time. Throws what reading them does, and not written.
Measured measure_run(const RunFiles& run, const MeasureOptions& how);

}  // namespace sinew
