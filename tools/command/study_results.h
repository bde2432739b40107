// SPDX-License-Identifier: GPL-3.0-or-later
// The results of a study on standard output.
//
//     print_study(study, "out/study", common);
#pragma once

#include <filesystem>

#include <sinew/study/study.h>
#include "command/command.h"

namespace sinew {

/// The limits, or without them the final values; everything with --json.
void print_study(const Study& study, const std::filesystem::path& folder, const Common& common);

}  // namespace sinew
