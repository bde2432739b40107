// SPDX-License-Identifier: GPL-3.0-or-later
// The common parts of the reports of a run and of a comparison: the page itself, the sections that
// both have, and the data that the page's script draws.
//
//     const std::string html = page_html({title, version, body, "metrics.csv", data, playback});
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/limits.h>
#include <sinew/metrics/report/charts.h>
#include <sinew/metrics/report/playback.h>
#include <sinew/metrics/report/report.h>
#include <sinew/metrics/summary.h>
#include <sinew/metrics/table.h>

namespace sinew {

struct WorstFrame {
  std::string_view metric;
  std::size_t frame = 0;  ///< frame of the run
  double time = 0;        ///< s
};

/// The data that the page draws, besides the playback.
struct PageData {
  std::vector<double> times;   ///< times of the charts' frames, ascending, s
  std::vector<double> angles;  ///< angles of the bones in them, degrees
  std::vector<Chart> charts;
  std::vector<LawCurve> curves;
  std::vector<WorstFrame> worst;
  std::vector<MachineColumn> machine = {};
};

/// One JSON object:
/// - charts: title, note, unit, baselines, span, folded, lines (name, points [time, value or null])
/// - angles: of the bones, [time, degrees]; none where no bone bends noticeably
/// - curves: title, note, across, up, lines (name, points [x, y])
/// - worst: metric, frame, time
/// - machine, where there is one: columns (name, unit, values), and which of them are shown first,
///   across and up
std::string page_json(const PageData& data);

/// The frames that the buttons beside the 3D view show: for each headline metric its worst frame
/// by `worst`, if any. A value of zero does not count.
std::vector<WorstFrame> worst_frames(std::span<const FrameMetrics> frames, const Summary& worst);

struct Page {
  std::string title, version;  ///< plain text
  std::string body;            ///< markup
  std::string table;           ///< the file with the numbers of every frame: metrics.csv
  PageData data;
  const Playback& playback;  ///< playback; without frames the page has no 3D view
  /// A sentence on where its numbers are; empty: frame by frame in `table`, and in metrics.json.
  std::string sources = {};
};

/// The whole page, UTF-8, with its style, script and libraries.
std::string page_html(const Page& page);

/// Says how a run ended that did not reach its end; "" of any other.
std::string end_band(const RunEnd& end);
/// The cards of what the verdict could judge; radius in m.
std::string verdict_cards(std::span<const FrameMetrics> frames, const Summary& summary,
                          double radius, std::size_t particles);

/// Sentences in a frame; empty without any.
std::string remarks(const std::vector<std::string>& sentences);

/// Heading and table; empty without checks.
std::string checks_table(std::span<const Check> checks);

/// Name, unit, meaning and formula of a metric.
std::string described(const Metric& metric);
std::string described(const RunMetric& metric);

/// Heading, hint and container of the charts; `with_view`: a click moves the 3D view to that time.
std::string charts_section(bool with_view);

/// Heading, hint and container of the curves; empty without any.
std::string curves_section(const std::string& title, const std::vector<LawCurve>& curves,
                           const std::string& hint = "");

/// Heading, hint and container of the chart of a testing machine; empty without one.
std::string machine_section(std::span<const MachineColumn> columns);

/// The 3D view and its controls; `worst` labels the buttons that show a frame.
std::string view_section(std::string_view worst);

/// Lists of facts side by side; empty where there are none.
std::string fact_lists(const std::vector<FactGroup>& groups);

/// A collapsed block of text, such as a scene; empty where there is none.
std::string folded(const std::string& title, const std::string& text);

/// A block of markup under a heading with which a reader folds it.
std::string unfolded(const std::string& title, const std::string& markup);

// The files embedded in every page.
std::string_view page_style();
std::string_view view_script();    ///< the 3D view, its parts and colors
std::string_view page_script();    ///< what a report has beside it
std::string_view view_markup();    ///< the 3D view and its controls
std::string_view chart_library();  ///< Chart.js
std::string_view scene_library();  ///< three.js and its orbit controls
std::string_view licenses();       ///< texts of the libraries, plain

}  // namespace sinew
