// SPDX-License-Identifier: GPL-3.0-or-later
// report.html: one page that documents a run and its results. It needs no network and no other
// files but the pictures it links.
//
//     write_file("report.html", report_html(report_input(run, std::move(measured))));
#pragma once

#include <span>
#include <string>
#include <vector>

#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/limits.h>
#include <sinew/metrics/report/charts.h>
#include <sinew/metrics/report/playback.h>
#include <sinew/metrics/summary.h>

namespace sinew {

struct Fact {
  std::string name, value;
};

/// A list of facts under a heading: "Run" (particles, steps, ...), "Material", ...
struct FactGroup {
  std::string title;
  std::vector<Fact> facts;
};

struct Picture {
  std::string path;  ///< relative to the report: pictures/bent.png
  std::string caption;
};

/// A law of the scene drawn as curves; a curve's x ascends.
struct CurveLine {
  std::string name;
  std::vector<double> x, y;
};
struct LawCurve {
  std::string title, note;  ///< what it is, and its formula
  std::string across, up;   ///< labels of the axes, with units
  std::vector<CurveLine> lines;
};

/// Values of what supports, loads and probes do, one per frame.
struct MachineColumn {
  std::string name, unit;
  std::vector<double> values;
};

/// How a run ended.
struct RunEnd {
  enum class Kind { finished, waits, broke } kind = Kind::finished;  ///< waits: can be resumed
  double time = 0, of = 0;  ///< its last frame, and what was asked for, s
  std::string why;          ///< cause and cure; empty where it is finished
};

/// Texts are plain; the page escapes them.
struct ReportInput {
  std::string title;    ///< the scene's name
  std::string subject;  ///< what was run, in a sentence
  std::string version;  ///< version of sinew
  double radius = 0;    ///< radius of a particle, m
  double modulus = 0;   ///< Young's, Pa; 0: not known
  std::size_t particles = 0;
  RunEnd end;
  std::vector<std::string> warnings;  ///< what is doubtful in the scene, each with its cure
  std::vector<FactGroup> facts;
  std::vector<FrameMetrics> frames;  ///< one at least
  Summary summary;                   ///< summary of these frames
  std::vector<Check> checks;
  std::vector<LawCurve> curves;
  std::vector<Chart> charts;           ///< more of them: of bones, supports, loads and probes
  std::vector<MachineColumn> machine;  ///< all of the same length; the page offers any two of them
  Playback playback;                   ///< playback; without frames the page has no 3D view
  std::vector<Picture> pictures;
  std::string movie;       ///< relative to the report, or empty
  std::string scene_text;  ///< the resolved scene
};

/// The whole page, UTF-8.
std::string report_html(const ReportInput& input);

}  // namespace sinew
