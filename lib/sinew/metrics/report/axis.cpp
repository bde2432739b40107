// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/axis.h>

#include <algorithm>
#include <cmath>

#include <sinew/metrics/report/markup.h>

namespace sinew {
namespace {

constexpr double least_span = 1e-3;  // of the values' size: below it a curve is flat, not noise

/// The next of 1, 2, 5, 10, ... times a power of ten.
double round_step(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (step <= factor * power * (1 + 1e-9)) return factor * power;
  return 10 * power;
}

double step_for(double low, double high, int count) { return round_step((high - low) / count); }

/// Ends far enough apart to draw between.
void widen(double& low, double& high) {
  const double size = std::max(std::abs(low), std::abs(high));
  if (size == 0) high = 1;
  const double span = least_span * size;
  if (size == 0 || high - low >= span) return;
  const double middle = (low + high) / 2;
  low = middle - span / 2;
  high = middle + span / 2;
}

std::string tick_text(double value, double step, double largest) {
  if (value == 0) return "0";
  if (largest >= 1e5 || largest < 1e-3) return readable(value);
  return fixed(value, std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9))));
}

void add_ticks(Axis& axis, double step) {
  const double tolerance = 1e-9 * step;
  const double largest = std::max(std::abs(axis.low), std::abs(axis.high));
  const auto first = static_cast<long long>(std::ceil((axis.low - tolerance) / step));
  const auto last = static_cast<long long>(std::floor((axis.high + tolerance) / step));
  for (long long i = first; i <= last; ++i) {
    axis.ticks.push_back(static_cast<double>(i) * step);
    axis.texts.push_back(tick_text(axis.ticks.back(), step, largest));
  }
}

}  // namespace

Axis round_axis(double low, double high, int count) {
  widen(low, high);
  const double step = step_for(low, high, count);
  Axis axis{std::floor(low / step + 1e-9) * step, std::ceil(high / step - 1e-9) * step, {}, {}};
  add_ticks(axis, step);
  return axis;
}

Axis tight_axis(double low, double high, int count) {
  widen(low, high);
  Axis axis{low, high, {}, {}};
  add_ticks(axis, step_for(low, high, count));
  return axis;
}

double place_on(const Axis& axis, double value, double from, double to) {
  return from + (value - axis.low) / (axis.high - axis.low) * (to - from);
}

}  // namespace sinew
