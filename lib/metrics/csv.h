// SPDX-License-Identifier: GPL-3.0-or-later
// metrics.csv: a row per frame, a column per metric, the time first. Opens in ParaView and in
// spreadsheets without options.
#pragma once

#include <cmath>
#include <span>
#include <string>

#include "core/settings_table.h"
#include "metrics/frame.h"

namespace sinew {

/// The whole file. Numbers read back as the same bits; "nan" where a metric was not measured.
std::string metrics_csv(std::span<const FrameMetrics> frames);

/// A line of the columns' names, then one per row. Numbers read back as the same bits.
template <class Table, class Rows>
std::string csv_text(const Table& columns, const Rows& rows) {
  std::string text;
  for (const auto& column : columns) {
    if (!text.empty()) text += ',';
    text += column.name;
  }
  for (const auto& row : rows) {
    char separator = '\n';
    for (const auto& column : columns) {
      const double value = row.*column.value;
      text += separator;
      text += std::isnan(value) ? "nan" : number_text(value);
      separator = ',';
    }
  }
  return text + '\n';
}

}  // namespace sinew
