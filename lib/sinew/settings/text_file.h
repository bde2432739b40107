// SPDX-License-Identifier: GPL-3.0-or-later
// A scene's text before it is parsed, and the paths in it.
//
//     const std::string text = read_text(path);
//     check_text(text, path.string());
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include <sinew/core/error.h>
#include <sinew/settings/settings.h>

namespace sinew {

inline constexpr std::size_t longest_scene = std::size_t{64} << 20;  // bytes

/// The whole file. Throws bad input for a missing or unreadable file, a directory, and a file of
/// more than longest_scene bytes.
std::string read_text(const std::filesystem::path& path);

/// Throws bad input, with line and column, for text that is not UTF-8, has control characters, or
/// is indented with tabs.
void check_text(std::string_view text, const std::string& file);

/// Where `offset` (bytes) lies in `text`; columns count characters.
Place place_of(std::string_view text, std::size_t offset, const std::string& file);

/// The reverse: the offset of a place, or text.size() when it has none.
std::size_t offset_of(std::string_view text, const Place& place);

// Files named in a scene, relative to its folder and to the current directory.

/// The path from `folder` to `path`. Links to folders are followed, a link to the file itself is
/// not.
std::filesystem::path seen_from(const std::filesystem::path& folder,
                                const std::filesystem::path& path);

/// A path as the scene in `folder` writes it: relative ones from there. "" stays.
std::string path_in(const std::filesystem::path& folder, const std::string& path);

/// The files that a scene names: meshes, rigs, clips, images; as the settings have them.
std::vector<std::string> files_of(const Settings& settings);

/// Makes the scene's paths, relative to `folder`, relative to the current directory. Those given on
/// the command line already are.
void open_paths_from_here(Settings& settings, const std::filesystem::path& folder);

}  // namespace sinew
