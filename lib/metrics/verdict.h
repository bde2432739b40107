// SPDX-License-Identifier: GPL-3.0-or-later
// What a run amounts to, in five numbers and a few words.
#pragma once

#include <array>
#include <span>
#include <string>

#include "metrics/frame.h"
#include "metrics/summary.h"

namespace sinew {

enum class Level { good, fair, poor, unknown };

struct VerdictItem {
  std::string label, value, meaning;  ///< plain text
  Level level = Level::unknown;
};

/// Volume error, distance from the rigid pose far from joints, broken neighbours, inverted
/// particles, and the residual after the return or else the turn of the tip. Worst frame each, the
/// last two at the end. radius in m.
std::array<VerdictItem, 5> verdict(std::span<const FrameMetrics> frames, const Summary& summary,
                                   double radius);

}  // namespace sinew
