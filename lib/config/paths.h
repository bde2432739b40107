// SPDX-License-Identifier: GPL-3.0-or-later
// Files named in a scene, seen from its folder and from the current directory.
#pragma once

#include <filesystem>
#include <string>

#include "core/settings.h"

namespace sinew {

/// The way from `folder` to `path`. Links to folders on the way are followed, a link to the file
/// itself is not.
std::filesystem::path seen_from(const std::filesystem::path& folder,
                                const std::filesystem::path& path);

/// A path as the scene in `folder` writes it: relative ones from there. "" stays.
std::string path_in(const std::filesystem::path& folder, const std::string& path);

/// Turns the relative paths that the scene in `folder` gives into paths from the current directory.
/// Those given elsewhere (on the command line) are such paths already.
void open_paths_from_here(Settings& settings, const std::filesystem::path& folder);

}  // namespace sinew
