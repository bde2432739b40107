// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/chart.h>

#include <algorithm>
#include <cmath>

#include <sinew/metrics/report/axis.h>
#include <sinew/metrics/report/markup.h>

namespace sinew {
namespace {

// The drawing's own units; the page scales it to its width.
constexpr double width = 440, left = 50, right = 428, top = 10, bottom = 176;
constexpr double strip_top = 196, strip_bottom = 220, height = 242;
constexpr std::size_t pieces = 400;  // two points in each are as many as the width can show

std::string at(double x, double y) { return fixed(x, 1) + ' ' + fixed(y, 1); }

std::string text(double x, double y, const std::string& words, const std::string& kind) {
  return element("text", escaped(words),
                 "class=\"" + kind + "\" x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\"");
}

std::string rule(double x1, double y1, double x2, double y2, const std::string& kind) {
  return "<path class=\"" + kind + "\" d=\"M" + at(x1, y1) + 'L' + at(x2, y2) + "\"/>\n";
}

/// The points of a line; a gap begins a new stroke.
std::string stroke(const std::vector<double>& times, const std::vector<double>& values,
                   const Axis& time, const Axis& scale, double low_y, double high_y) {
  std::string path;
  bool pen_down = false;
  for (const std::size_t i : drawn_places(values)) {
    const bool there = drawable(values[i]);
    if (there)
      path += (pen_down ? 'L' : 'M') +
              at(place_on(time, times[i], left, right), place_on(scale, values[i], low_y, high_y));
    pen_down = there;
  }
  return path;
}

Axis scale_of(const Chart& chart) {
  double low = INFINITY, high = -INFINITY;
  const auto include = [&](double value) {
    if (!drawable(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  };
  for (const double value : chart.baselines) include(value);
  for (const Line& line : chart.lines)
    for (const double value : line.values) include(value);
  return low <= high ? round_axis(low, high, 4) : round_axis(0, 1, 4);
}

std::string grid(const Axis& scale) {
  std::string out;
  for (std::size_t i = 0; i < scale.ticks.size(); ++i) {
    const double y = place_on(scale, scale.ticks[i], bottom, top);
    out += rule(left, y, right, y, scale.ticks[i] == 0 ? "zero" : "grid");
    out += text(left - 6, y + 3, scale.texts[i], "end");
  }
  return out;
}

std::string time_axis(const Axis& time, double foot) {
  std::string out;
  for (std::size_t i = 0; i < time.ticks.size(); ++i) {
    const double x = place_on(time, time.ticks[i], left, right);
    out += rule(x, foot, x, foot + 4, "zero");
    const bool last = i + 1 == time.ticks.size();
    const bool at_edge = x > right - 15;  // a centered text would leave the drawing
    out += text(at_edge ? width - 2 : x, foot + 16, time.texts[i] + (last ? " s" : ""),
                at_edge ? "end" : "middle");
  }
  return out;
}

/// The bones' angle as a quiet area.
std::string strip(const Chart& chart, const Axis& time) {
  double largest = 1;
  for (const double angle : chart.angles) largest = std::max(largest, angle);
  const Axis scale{0, largest, {}, {}};
  const std::string line = stroke(chart.times, chart.angles, time, scale, strip_bottom, strip_top);
  return "<path class=\"bone\" d=\"" + line + 'L' +
         at(place_on(time, chart.times.back(), left, right), strip_bottom) + 'L' +
         at(place_on(time, chart.times.front(), left, right), strip_bottom) + "Z\"/>\n" +
         rule(left, strip_bottom, right, strip_bottom, "zero") +
         text(left - 6, strip_top + 6, fixed(largest, 0) + "°", "end") +
         text(left - 6, strip_bottom, "bones", "end");
}

bool has_strip(const Chart& chart) {
  return !chart.angles.empty() &&
         std::all_of(chart.angles.begin(), chart.angles.end(), [](double a) { return a >= 0; });
}

std::string svg(const Chart& chart) {
  const Axis time = tight_axis(chart.times.front(), chart.times.back(), 6);
  const Axis scale = scale_of(chart);
  std::string out = grid(scale);
  for (std::size_t i = 0; i < chart.lines.size(); ++i)
    out += "<path class=\"line c" + std::to_string(i + 1) + "\" d=\"" +
           stroke(chart.times, chart.lines[i].values, time, scale, bottom, top) + "\"/>\n";
  const bool with_strip = has_strip(chart);
  if (with_strip) out += strip(chart, time);
  out += time_axis(time, with_strip ? strip_bottom : bottom);
  const double tall = with_strip ? height : height - (strip_bottom - bottom);
  return element("svg", '\n' + out,
                 "role=\"img\" aria-label=\"" + escaped(chart.title) +
                     " against time\" viewBox=\"0 0 " + fixed(width, 0) + ' ' + fixed(tall, 0) +
                     '"');
}

std::string legend(const Chart& chart) {
  std::string out;
  for (std::size_t i = 0; i < chart.lines.size(); ++i)
    out += "<span><i class=\"c" + std::to_string(i + 1) + "\"></i>" + escaped(chart.lines[i].name) +
           "</span>\n";
  return element("p", out, "class=\"legend\"");
}

}  // namespace

bool drawable(double value) { return std::abs(value) < 1e300; }

std::vector<std::size_t> drawn_places(const std::vector<double>& values) {
  std::vector<std::size_t> places;
  const std::size_t grain = values.size() / pieces + 1;
  for (std::size_t begin = 0; begin < values.size(); begin += grain) {
    const std::size_t end = std::min(values.size(), begin + grain);
    if (grain <= 2) {
      for (std::size_t i = begin; i < end; ++i) places.push_back(i);
      continue;
    }
    std::size_t low = begin, high = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (!(values[i] >= values[low])) low = i;
      if (!(values[i] <= values[high])) high = i;
    }
    places.insert(places.end(), {std::min(low, high), std::max(low, high)});
  }
  return places;
}

std::string chart_html(const Chart& chart) {
  if (chart.times.empty()) return "";
  const std::string unit =
      chart.unit.empty() ? "" : element("span", escaped(chart.unit), "class=\"unit\"");
  const std::string caption = element("h3", escaped(chart.title) + ' ' + unit) +
                              element("p", escaped(chart.note)) + legend(chart);
  return element("figure", element("figcaption", caption) + svg(chart), "class=\"chart\"");
}

}  // namespace sinew
