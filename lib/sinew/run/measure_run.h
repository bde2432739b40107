// SPDX-License-Identifier: GPL-3.0-or-later
// A run measured frame by frame.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include <sinew/metrics/bone_metrics.h>
#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/limits.h>
#include <sinew/metrics/report/playback.h>
#include <sinew/metrics/sections.h>
#include <sinew/metrics/summary.h>
#include <sinew/run/run_files.h>

namespace sinew {

// Metrics of a run's surface against other surfaces, and of its own folds: what lib/metrics leaves
// to whoever has meshes at hand.

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

struct Measured {
  std::vector<FrameMetrics> frames;
  Summary summary;
  std::vector<Check> checks;
  Playback playback;
  std::vector<BoneMetrics> bones;        ///< of every frame
  std::vector<SectionMetrics> sections;  ///< of every frame
};

struct HowToMeasure {
  std::vector<Limit> limits;
  std::optional<SurfaceSeries> reference;
  std::vector<std::string_view> arrays;  ///< to be written as the series "values"
  bool ahead = true;                     ///< read the frame that comes while one is measured
  bool playback = true;                  ///< keep one
};

/// The body of a run at rest.
RestBody rest_of(const RunFiles& run);

/// Two frames are in memory at a time. Throws what reading them does, and not written.
Measured measure_run(const RunFiles& run, const HowToMeasure& how);

}  // namespace sinew
