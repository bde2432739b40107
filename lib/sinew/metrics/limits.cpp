// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/limits.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/metrics/table.h>

namespace sinew {
namespace {

constexpr std::array<std::string_view, 5> over_names{"", "min", "max", "mean", "final"};
// Longer ones first: ">" would match the start of ">=".
constexpr std::array<std::pair<std::string_view, Comparison>, 5> operators{
    {{">=", Comparison::at_least},
     {"<=", Comparison::at_most},
     {"==", Comparison::equal},
     {">", Comparison::above},
     {"<", Comparison::below}}};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

Error unreadable(std::string_view expression, const std::string& why) {
  return bad_input("--fail-on " + shown(expression) + ": " + why,
                   "write it like 'volume_error > 0.05' or 'final(tip_angle) < 89'");
}

std::vector<std::string_view> known_names() {
  std::vector<std::string_view> names;
  for (const Metric& metric : metrics_table()) names.push_back(metric.name);
  for (const RunMetric& metric : run_metrics_table()) names.push_back(metric.name);
  return names;
}

void require_known(std::string_view name) {
  const auto names = known_names();
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  const std::string close = nearest(name, names);
  throw bad_input("--fail-on: there is no metric " + shown(name),
                  close.empty() ? "use a column of metrics.csv" : "did you mean " + close + "?");
}

double number(std::string_view text, std::string_view expression) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw unreadable(expression, shown(text) + " is no number");
  return value;
}

/// Splits "max(name)" or "name".
void read_subject(Limit& limit, std::string_view subject, std::string_view expression) {
  const auto open = subject.find('(');
  if (open != subject.npos) {
    const std::string_view form = trimmed(subject.substr(0, open));
    const auto found = std::find(over_names.begin() + 1, over_names.end(), form);
    if (found == over_names.end() || subject.back() != ')')
      throw unreadable(expression, "only min(), max(), mean() and final() can enclose a metric");
    limit.over = static_cast<Over>(found - over_names.begin());
    subject = trimmed(subject.substr(open + 1, subject.size() - open - 2));
  }
  require_known(subject);
  limit.metric = subject;
}

bool passed(Comparison comparison, double value, double limit) {
  switch (comparison) {
    case Comparison::above:
      return value > limit;
    case Comparison::at_least:
      return value >= limit;
    case Comparison::below:
      return value < limit;
    case Comparison::at_most:
      return value <= limit;
    case Comparison::equal:
      return value == limit;
  }
  return false;
}

/// How near a value is to violating the limit: larger is nearer.
double nearness(const Limit& limit, double value) {
  if (limit.comparison == Comparison::equal) return -std::abs(value - limit.value);
  const bool up = limit.comparison == Comparison::above || limit.comparison == Comparison::at_least;
  return up ? value : -value;
}

/// The measured frame whose value is nearest to violating the limit, the first of several.
template <class Nearness>
std::optional<std::size_t> nearest_frame(std::span<const FrameMetrics> frames, const Metric& metric,
                                         const Nearness& near) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double value = frames[i].*metric.value;
    if (std::isnan(value)) continue;
    if (!found || near(value) > near(frames[*found].*metric.value)) found = i;
  }
  return found;
}

std::optional<std::size_t> frame_of(const Limit& limit, std::span<const FrameMetrics> frames,
                                    const Metric& metric) {
  switch (limit.over) {
    case Over::any_frame:
      return nearest_frame(frames, metric, [&](double value) { return nearness(limit, value); });
    case Over::min:
      return nearest_frame(frames, metric, [](double value) { return -value; });
    case Over::max:
      return nearest_frame(frames, metric, [](double value) { return value; });
    case Over::final:
      return frames.size() - 1;
    case Over::mean:
      return std::nullopt;
  }
  return std::nullopt;
}

std::string text_of(const Limit& limit) {
  const auto symbol = std::find_if(operators.begin(), operators.end(), [&](const auto& candidate) {
    return candidate.second == limit.comparison;
  });
  const std::string form(over_names[static_cast<std::size_t>(limit.over)]);
  const std::string subject = form.empty() ? limit.metric : form + '(' + limit.metric + ')';
  return subject + ' ' + std::string(symbol->first) + ' ' + number_text(limit.value);
}

double run_value(std::string_view name, const Summary& summary) {
  for (const RunMetric& metric : run_metrics_table())
    if (metric.name == name) return summary.*metric.value;
  return not_measured;
}

}  // namespace

Limit parse_limit(std::string_view expression) {
  const auto at = expression.find_first_of("<>=");
  if (at == expression.npos) throw unreadable(expression, "it compares nothing");
  const std::string_view rest = expression.substr(at);
  const auto found = std::find_if(operators.begin(), operators.end(), [&](const auto& candidate) {
    return rest.starts_with(candidate.first);
  });
  if (found == operators.end()) throw unreadable(expression, "only > >= < <= == compare");
  Limit limit;
  limit.comparison = found->second;
  read_subject(limit, trimmed(expression.substr(0, at)), expression);
  limit.value = number(trimmed(rest.substr(found->first.size())), expression);
  return limit;
}

Check check_limit(const Limit& limit, std::span<const FrameMetrics> frames,
                  const Summary& summary) {
  Check check{limit.metric, text_of(limit), not_measured, limit.value, {}, false};
  const std::size_t index = metric_index(limit.metric);
  if (index < metrics_table().size()) {
    const Metric& metric = metrics_table()[index];
    check.frame = frame_of(limit, frames, metric);
    if (limit.over == Over::mean) check.value = summary.metrics[index].mean;
    if (check.frame) check.value = frames[*check.frame].*metric.value;
  } else {
    check.value = run_value(limit.metric, summary);
  }
  check.pass = !std::isnan(check.value) && !passed(limit.comparison, check.value, limit.value);
  return check;
}

std::string describe(const Check& check) {
  if (std::isnan(check.value)) return check.expression + ": fails, it was not measured";
  std::string text =
      check.expression + (check.pass ? ": kept with " : ": fails with ") + number_text(check.value);
  if (check.frame) text += " in frame " + std::to_string(*check.frame);
  return text;
}

}  // namespace sinew
