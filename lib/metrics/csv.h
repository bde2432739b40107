// SPDX-License-Identifier: GPL-3.0-or-later
// metrics.csv: a row per frame, a column per metric, the time first. Opens in ParaView and in
// spreadsheets without options.
#pragma once

#include <span>
#include <string>

#include "metrics/frame.h"

namespace sinew {

/// The whole file. Numbers read back as the same bits; "nan" where a metric was not measured.
std::string metrics_csv(std::span<const FrameMetrics> frames);

}  // namespace sinew
