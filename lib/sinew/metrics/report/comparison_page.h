// SPDX-License-Identifier: GPL-3.0-or-later
// report.html of a comparison: two runs beside each other on one page and in one 3D view.
//
//     write_file("report.html", comparison_html(input));
#pragma once

#include <array>
#include <string>
#include <vector>

#include <sinew/metrics/comparison.h>
#include <sinew/metrics/report/charts.h>
#include <sinew/metrics/report/playback.h>
#include <sinew/metrics/report/report.h>

namespace sinew {

/// Both playbacks in one, of the frames that both have. The second is shifted along the shorter of
/// its sides, so that the page's camera sees them next to each other. Bones of the same name have
/// one color, and the others' names get the prefixes.
Playback side_by_side(const Playback& first, const Playback& second,
                      const std::array<std::string, 2>& prefixes);

/// Texts are plain; the page escapes them.
struct ComparisonInput {
  std::string version;  ///< version of sinew
  RunComparison comparison;
  Playback playback;             ///< playback of both, see side_by_side(); no frames: no 3D view
  std::vector<FactGroup> facts;  ///< what differs between the scenes
  std::string first_scene, second_scene;  ///< resolved
  std::vector<Chart> charts = {};         ///< before those of the metrics
  std::vector<LawCurve> curves = {};      ///< loads over displacements
};

/// The whole page, UTF-8.
std::string comparison_html(const ComparisonInput& input);

}  // namespace sinew
