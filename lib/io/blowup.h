// SPDX-License-Identifier: GPL-3.0-or-later
// blowup.vtu: the body before the step in which a simulation became unstable, its offenders marked.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/dataset.h"
#include "core/particles.h"
#include "io/frames.h"

namespace sinew {

/// A particle's part in the step that failed.
enum class Offence : std::int32_t { none = 0, too_fast = 1, not_finite = 2 };

struct BlowupFrame {
  const Particles& before;             ///< the step, in any order
  const Points& rest;                  ///< m, in the written order
  std::span<const std::int32_t> bone;  ///< in the written order
  std::span<const Offence> offence;    ///< in the written order
  std::span<const double> moved;  ///< in the step, relative to its bone, in radii; 0 if not finite
};

Dataset blowup_dataset(const BlowupFrame& frame, Moment moment);

/// Throws not written.
void write_blowup(const std::filesystem::path& path, const BlowupFrame& frame, Moment moment);

}  // namespace sinew
