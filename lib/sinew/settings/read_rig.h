// SPDX-License-Identifier: GPL-3.0-or-later
// Bones and tracks, in a scene or in a YAML file of their own: a rig holds a list of bones, a clip
// a list of tracks and, if its keys count frames, their frame_rate.
#pragma once

#include <filesystem>
#include <optional>

#include <sinew/settings/settings.h>
#include <sinew/settings/yaml_tree.h>

namespace sinew {

/// The lists in the sections of a scene. A skeleton with a file needs no bones. Throws bad input
/// for a list and a file at once, and as read_fields does.
void read_bones(const YamlNode& skeleton, Settings& settings);
void read_tracks(const YamlNode& motion, Settings& settings);
void read_bound(const YamlNode& binding, Settings& settings);

/// Reads what skeleton.file and motion.file name when it is YAML, and takes the name out: the
/// settings then hold all there is. Other files stay for their readers. The scene's own frame_rate
/// goes before the clip's. Throws bad input naming the line of the file.
void read_rig_files(Settings& settings);

/// The bones or the tracks of a file that holds nothing else, beside defaults; none for others.
/// Throws bad input naming the line.
std::optional<Settings> read_rig_alone(const std::filesystem::path& path);

}  // namespace sinew
