// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers behind the report's charts and its 3D view, as the page's script reads them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <sinew/metrics/report/chart.h>
#include <sinew/metrics/report/playback.h>
#include <sinew/metrics/report/report.h>

namespace sinew {

/// One JSON object that may stand in a script element of any page:
/// - charts: id, title, unit, baselines, lines (name, points [time, value or null])
/// - angles: of the bones, [time, degrees]
/// - curves: title, note, across, up, lines (name, points [x, y])
/// - worst: label, frame and time of the worst frame of each telling metric
/// - playback: see playback_json(); null without one
std::string page_data(const ReportInput& input, std::span<const Chart> charts);

}  // namespace sinew
