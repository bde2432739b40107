// SPDX-License-Identifier: GPL-3.0-or-later
// A setting given on the command line: --set body.radius=0.01.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <sinew/settings/settings.h>
#include <sinew/settings/yaml_tree.h>

namespace sinew {

struct Override {
  std::string path;   ///< section.key
  std::string value;  ///< YAML: a word, a number, [x, y, z]
  std::string given;  ///< how it stood on the command line: errors name it
};

/// Splits "section.key=value". Throws bad input for another shape.
Override parse_override(const std::string& text);

/// Puts the value into the tree of a scene and takes out its rival (body.radius that of
/// body.count). A tree that is no mapping of mappings stays as it is: its reader says what is wrong
/// with it. Throws bad input, as "--set KEY=VALUE: ...", for wrong YAML.
void apply_override(const Override& given, YamlNode& scene);

// A scene file as settings: one YAML mapping with the sections and keys of core/settings_table.h.
//
// Numbers may be written as fractions (1/30). Every value knows its line, so that whoever finds it
// wrong later can name it (Settings::place).

/// Reads and checks a scene. An override stands in place of the scene's own value, and removes its
/// rival (body.radius that of body.count); of two for the same key the last holds.
/// Paths are relative to the scene, in overrides to the current directory; in the result they can
/// be opened from the current directory. Throws bad input, "FILE:LINE:COLUMN: what is wrong; what
/// to do" or "--set KEY=VALUE: ...".
Settings read_scene(const std::filesystem::path& path, std::span<const Override> overrides = {});

/// The settings of a body alone: a mesh that is to be filled, with overrides for the sections body
/// and material; all else has its defaults. Throws bad input as read_scene does.
Settings settings_of_mesh(const std::filesystem::path& mesh, std::span<const Override> overrides);

}  // namespace sinew
