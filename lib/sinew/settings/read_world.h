// SPDX-License-Identifier: GPL-3.0-or-later
// The section world of a scene: lists of obstacles, pins, fields and muscles, some with lists of
// keys.
//
//     read_world(section, settings);  // fills settings.world
#pragma once

#include <array>
#include <filesystem>
#include <string_view>

#include <sinew/settings/settings.h>
#include <sinew/settings/yaml_tree.h>

namespace sinew {

/// The names of its lists.
inline constexpr std::array<std::string_view, 4> world_lists = {"obstacles", "pins", "fields",
                                                                "muscles"};

/// Reads the lists, all of which are optional. Throws bad input, with the scene's line, as
/// read_fields() does, and for what is incomplete or contradictory: a shape without its sizes, a
/// box without one of its corners, a bone as well as keys, a name used twice, keys out of order.
void read_world(const YamlNode& world, Settings& settings);

/// The lists as a scene in `folder` writes them; each key has a comment where it first occurs.
std::string world_text(const Settings& settings, const std::filesystem::path& folder);

}  // namespace sinew
