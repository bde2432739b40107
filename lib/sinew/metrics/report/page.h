// SPDX-License-Identifier: GPL-3.0-or-later
// What the reports of a run and of a comparison have in common.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/report/chart.h>
#include <sinew/metrics/report/report.h>
#include <sinew/metrics/summary.h>

namespace sinew {

struct Page {
  std::string title, version;  ///< plain text
  std::string body;            ///< markup
  std::string ending;          ///< where the numbers are, plain text
  std::string data;            ///< JSON that may stand in a script: see page_data.h
};

/// The whole page, UTF-8, with everything that draws it.
std::string page_html(const Page& page);

/// The verdict's cards; radius in m.
std::string verdict_cards(std::span<const FrameMetrics> frames, const Summary& summary,
                          double radius);

/// Heading, hint and figures; whether the page has a 3D view that a click may lead to.
std::string charts_section(const std::vector<Chart>& charts, bool with_view);

/// Lists of facts beside each other; empty without any.
std::string fact_lists(const std::vector<FactGroup>& groups);

/// Text to be opened, such as a scene; empty where there is none.
std::string folded(const std::string& title, const std::string& text);

/// The 3D view and its controls; `worst` stands before the buttons that lead to a frame.
std::string view_section(std::string_view worst);

}  // namespace sinew
