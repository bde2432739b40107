// SPDX-License-Identifier: GPL-3.0-or-later
// The section world of a scene: lists of obstacles, pins, fields and muscles, some with lists of
// keys.
#pragma once

#include <array>
#include <filesystem>
#include <string_view>

#include <sinew/settings/settings.h>
#include <sinew/settings/yaml_tree.h>

namespace sinew {

/// The keys of its lists.
inline constexpr std::array<std::string_view, 4> world_lists = {"obstacles", "pins", "fields",
                                                                "muscles"};

/// Reads the lists, which may all be missing. Throws bad input, naming the scene's line, as
/// read_fields does, and for what is said by halves or twice: a shape without its sizes, a box
/// without one of its corners, a bone and keys at once, a name used twice, keys out of order.
void read_world(const YamlNode& world, Settings& settings);

/// The lists as a scene in `folder` writes them; keys with a comment where they come first.
std::string world_text(const Settings& settings, const std::filesystem::path& folder);

}  // namespace sinew
