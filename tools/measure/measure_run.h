// SPDX-License-Identifier: GPL-3.0-or-later
// A run measured frame by frame.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "folder/run_files.h"
#include "measure/surface_metrics.h"
#include "metrics/bone_metrics.h"
#include "metrics/limits.h"
#include "metrics/report/film.h"
#include "metrics/sections.h"
#include "metrics/summary.h"

namespace sinew {

struct Measured {
  std::vector<FrameMetrics> frames;
  Summary summary;
  std::vector<Check> checks;
  Film film;
  std::vector<BoneMetrics> bones;        ///< of every frame
  std::vector<SectionMetrics> sections;  ///< of every frame
};

struct HowToMeasure {
  std::vector<Limit> limits;
  std::optional<SurfaceSeries> reference;
  std::vector<std::string_view> arrays;  ///< to be written as the series "values"
  bool ahead = true;                     ///< read the frame that comes while one is measured
  bool film = true;                      ///< keep one
};

/// The body of a run at rest.
RestBody rest_of(const RunFiles& run);

/// Two frames are in memory at a time. Throws what reading them does, and not written.
Measured measure_run(const RunFiles& run, const HowToMeasure& how);

}  // namespace sinew
