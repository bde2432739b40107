// SPDX-License-Identifier: GPL-3.0-or-later
// Bones and tracks, in a scene or in a YAML file of their own: a rig has a list of bones, a clip a
// list of tracks and, if its keys count frames, their frame_rate.
//
//     read_rig_files(settings);  // then settings.bones and settings.tracks are complete
#pragma once

#include <filesystem>
#include <optional>

#include <sinew/settings/settings.h>
#include <sinew/settings/yaml_tree.h>

namespace sinew {

/// The lists in the sections of a scene. A skeleton with a file needs no bones. Throws bad input
/// for both a list and a file, and as read_fields() does.
void read_bones(const YamlNode& skeleton, Settings& settings);
void read_tracks(const YamlNode& motion, Settings& settings);
void read_bound(const YamlNode& binding, Settings& settings);

/// Reads skeleton.file and motion.file when they are YAML, and clears the names: the settings are
/// then complete. Other formats are left to their readers. The scene's own frame_rate overrides the
/// clip's. Throws bad input with the line of the file.
void read_rig_files(Settings& settings);

/// The bones or the tracks of a file that has nothing else, with defaults otherwise; nothing for
/// other files. Throws bad input with the line.
std::optional<Settings> read_rig_alone(const std::filesystem::path& path);

}  // namespace sinew
