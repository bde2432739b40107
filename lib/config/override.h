// SPDX-License-Identifier: GPL-3.0-or-later
// A setting given on the command line: --set body.radius=0.01.
#pragma once

#include <string>

#include "config/yaml_tree.h"

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

}  // namespace sinew
