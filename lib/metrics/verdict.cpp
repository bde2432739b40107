// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/verdict.h"

#include <cmath>

#include "metrics/report/markup.h"
#include "metrics/table.h"

namespace sinew {
namespace {

struct Scale {
  double good, fair;                 ///< the largest values that still count as such
  std::array<const char*, 3> words;  ///< for good, fair, poor
};

// What the paper's own body reaches when all goes well lies at the upper end of "fair" or below.
constexpr Scale volume_scale{
    0.02, 0.1, {"keeps its volume", "volume changes visibly", "collapses"}};
constexpr Scale pose_scale{2, 5, {"follows its bones", "lags behind its bones", "lost its bones"}};
constexpr Scale broken_scale{0.01, 0.05, {"stays in one piece", "flows a little", "comes apart"}};
constexpr Scale inverted_scale{0, 3, {"nothing is inside out", "a few folds", "folds into itself"}};
constexpr Scale residual_scale{0.2, 1, {"returns to its shape", "keeps a trace", "stays deformed"}};
constexpr Scale tip_scale{1, 5, {"turns with its bone", "turns a little off", "does not follow"}};

VerdictItem judged(const char* label, double value, const std::string& text, const Scale& scale) {
  VerdictItem item{label, text, "not measured", Level::unknown};
  if (std::isnan(value)) return item;
  item.level = value <= scale.good ? Level::good : value <= scale.fair ? Level::fair : Level::poor;
  item.meaning = scale.words[static_cast<std::size_t>(item.level)];
  return item;
}

std::string with_unit(double value, int decimals, const char* unit) {
  return std::isnan(value) ? fixed(value, 0) : fixed(value, decimals) + unit;
}

VerdictItem last_item(std::span<const FrameMetrics> frames, const Summary& summary, double radius) {
  const double residual = summary.residual_rms / radius;
  if (!std::isnan(residual))
    return judged("residual after the return", residual, with_unit(residual, 2, " r"),
                  residual_scale);
  const double tip = frames.back().tip_angle, off = std::abs(tip - frames.back().bone_angle);
  return judged("turn of the tip at the end", off, with_unit(tip, 1, "°"), tip_scale);
}

}  // namespace

std::array<VerdictItem, 5> verdict(std::span<const FrameMetrics> frames, const Summary& summary,
                                   double radius) {
  const auto worst = [&](const char* name) { return summary.metrics[metric_index(name)].max; };
  const double volume = worst("volume_error"), pose = worst("pose_error_far_rms") / radius;
  const double inverted = worst("inverted"), bonds = worst("broken_bonds");
  const bool bonded = !std::isnan(bonds);
  const double broken = bonded ? bonds : worst("broken_neighbours");
  return {
      judged("volume error", volume, with_unit(100 * volume, 2, " %"), volume_scale),
      judged("from the rigid pose, away from joints", pose, with_unit(pose, 2, " r"), pose_scale),
      judged(bonded ? "broken bonds" : "broken neighbours", broken,
             with_unit(100 * broken, 2, " %"), broken_scale),
      judged("inverted particles", inverted, with_unit(inverted, 0, ""), inverted_scale),
      last_item(frames, summary, radius)};
}

}  // namespace sinew
