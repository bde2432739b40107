// SPDX-License-Identifier: GPL-3.0-or-later
// Settings given beside a scene, as by --set.
//
//     apply_override(parse_override("loads[tip].force=[0, 0, -1]"), scene);
#pragma once

#include <string>
#include <vector>

#include <sinew/settings/yaml_tree.h>

namespace sinew {

struct Override {
  std::string path;   ///< section.key; of entries of lists by name or place: loads[tip].force
  std::string value;  ///< YAML: a word, a number, [x, y, z]
  std::string given;  ///< text on the command line: errors quote it
};

/// A key of a path, and the entry of the list that it holds.
struct PathStep {
  std::string key, entry;  ///< entry: "" for none
};

/// "loads[tip].force" as its steps; none where it is no path of section and key.
std::vector<PathStep> steps_of(const std::string& path);

/// Splits "section.key=value". Throws bad input for another form.
Override parse_override(const std::string& text);

/// Sets the value in the tree of a scene and removes the other key of a pair (body.radius for
/// body.count). A tree that is no mapping of mappings is unchanged: its reader reports what is
/// wrong. Throws bad input, as "--set KEY=VALUE: ...", for invalid YAML and for an entry that a
/// list does not have.
void apply_override(const Override& given, YamlNode& scene);

/// The path with the places of entries in place of their names; unchanged where the scene has none
/// of that name.
std::string canonical_path(const std::string& path, const YamlNode& scene);

}  // namespace sinew
