// SPDX-License-Identifier: GPL-3.0-or-later
// The scene that a run writes beside its results.
#pragma once

#include <filesystem>
#include <string>

#include "core/settings.h"

namespace sinew {

/// Every setting with its default filled in, as a scene with a line and a comment for each. Paths
/// are relative to `folder`, where the scene will lie; read_scene gives the same settings back.
std::string resolved_scene(const Settings& settings, const std::filesystem::path& folder);

}  // namespace sinew
