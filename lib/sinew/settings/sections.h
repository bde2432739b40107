// SPDX-License-Identifier: GPL-3.0-or-later
// Readers of the sections of a scene that have lists (bones, tracks, the world), and the checks
// that involve more than one setting.
//
//     read_rig_files(settings);
//     check_together(settings);
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

#include <sinew/settings/settings.h>
#include <sinew/settings/yaml_tree.h>

namespace sinew {

// Bones and tracks, in a scene or in a YAML file of their own: a rig has a list of bones, a clip a
// list of tracks and, if its keys count frames, their frame_rate.

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

// The section world of a scene: lists of obstacles, pins, fields and muscles, some with lists of
// keys.

/// The names of its lists.
inline constexpr std::array<std::string_view, 5> world_lists = {"obstacles", "pins", "fields",
                                                                "muscles", "springs"};

/// Reads the lists, all of which are optional. Throws bad input, with the scene's line, as
/// read_fields() does, and for what is incomplete or contradictory: a shape without its sizes, a
/// box without one of its corners, a bone as well as keys, a name used twice, keys out of order.
void read_world(const YamlNode& world, Settings& settings);

/// The lists as a scene in `folder` writes them; each key has a comment where it first occurs.
std::string world_text(const Settings& settings, const std::filesystem::path& folder);

// Lists of the scene itself: materials of parts, and a testing machine of supports, loads and
// probes.

/// The names of its lists.
inline constexpr std::array<std::string_view, 4> machine_lists = {"materials", "supports", "loads",
                                                                  "probes"};

/// Reads the lists, all of which are optional. Throws bad input, with the scene's line, as
/// read_world() does, for a support that begins elsewhere than at rest, and for a load of no kind
/// or of several.
void read_machine(const YamlNode& scene, Settings& settings);
/// Throws bad input for two entries of one name; supports, loads and springs, whose rows are in one
/// table, count as one list.
void check_names_of_machine(const Settings& settings);

/// The lists that have entries, as a scene writes them.
std::string machine_text(const Settings& settings, const std::filesystem::path& folder);

// Checks that involve more than one setting.

/// Two keys that specify the same thing: at most one of them may be given.
struct EitherOr {
  std::string_view first, second;
  bool needed;  ///< one of them must be given
};

std::span<const EitherOr> either_or();

/// The other key of a pair, or "".
std::string_view rival_of(std::string_view path);

/// Sets the values of a named material, for keys that the scene does not give.
void apply_preset(Settings& settings);

/// Throws bad input, with the scene's line, for both or neither of a pair of keys, a >= b, frames
/// further apart than the duration of the run, up along forward, and a clip that ends before it
/// begins.
void check_together(const Settings& settings);

}  // namespace sinew
