// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/csv.h"

#include "metrics/table.h"

namespace sinew {

std::string metrics_csv(std::span<const FrameMetrics> frames) {
  return csv_text(metrics_table(), frames);
}

}  // namespace sinew
