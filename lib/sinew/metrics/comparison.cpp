// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/comparison.h>

#include <cmath>

#include <sinew/core/text.h>
#include <sinew/metrics/table.h>

namespace sinew {
namespace {

std::string csv_head() {
  std::string line = "time";
  for (const Metric& metric : metrics_table().subspan(1)) {
    const std::string name = ',' + std::string(metric.name);
    if (is_distance(metric.name)) {
      line += name;
      continue;
    }
    for (const char* part : {"_a", "_b", "_difference"}) (line += name) += part;
  }
  return line + '\n';
}

void append(std::string& line, double value) {
  line += ',';
  line += std::isnan(value) ? "nan" : number_text(value);
}

Summary summary_of_differences(const RunComparison& compared) {
  Summary summary = summarize(compared.differences, compared.first.radius);
  for (const RunMetric& metric : run_metrics_table())
    summary.*metric.value =
        compared.second.summary.*metric.value - compared.first.summary.*metric.value;
  return summary;
}

}  // namespace

bool is_distance(std::string_view metric) { return metric.starts_with("reference_"); }

FrameMetrics difference(const FrameMetrics& first, const FrameMetrics& second) {
  FrameMetrics out;
  out.time = first.time;
  for (const Metric& metric : metrics_table().subspan(1)) {
    const double own = second.*metric.value;
    out.*metric.value = is_distance(metric.name) ? own : own - first.*metric.value;
  }
  return out;
}

RunComparison compare(ComparedRun first, ComparedRun second) {
  RunComparison compared{std::move(first), std::move(second), {}, {}, {}, {}};
  for (std::size_t i = 0; i < compared.first.frames.size(); ++i)
    compared.differences.push_back(difference(compared.first.frames[i], compared.second.frames[i]));
  compared.summary = summary_of_differences(compared);
  return compared;
}

std::string comparison_csv(const RunComparison& compared) {
  std::string text = csv_head();
  for (std::size_t i = 0; i < compared.differences.size(); ++i) {
    text += number_text(compared.differences[i].time);
    for (const Metric& metric : metrics_table().subspan(1)) {
      if (!is_distance(metric.name)) {
        append(text, compared.first.frames[i].*metric.value);
        append(text, compared.second.frames[i].*metric.value);
      }
      append(text, compared.differences[i].*metric.value);
    }
    text += '\n';
  }
  return text;
}

std::optional<std::size_t> largest_difference(const RunComparison& compared, std::size_t metric) {
  const auto value = metrics_table()[metric].value;
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < compared.differences.size(); ++i) {
    const double size = std::abs(compared.differences[i].*value);
    if (std::isnan(size)) continue;
    if (!found || size > std::abs(compared.differences[*found].*value)) found = i;
  }
  return found;
}

}  // namespace sinew
