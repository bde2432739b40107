// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/csv.h"

#include <cmath>

#include "core/settings_table.h"
#include "metrics/table.h"

namespace sinew {

std::string metrics_csv(std::span<const FrameMetrics> frames) {
  std::string text;
  for (const Metric& metric : metrics_table()) {
    if (!text.empty()) text += ',';
    text += metric.name;
  }
  for (const FrameMetrics& frame : frames) {
    char separator = '\n';
    for (const Metric& metric : metrics_table()) {
      const double value = frame.*metric.value;
      text += separator + (std::isnan(value) ? "nan" : number_text(value));
      separator = ',';
    }
  }
  return text + '\n';
}

}  // namespace sinew
