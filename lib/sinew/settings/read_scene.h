// SPDX-License-Identifier: GPL-3.0-or-later
// Scene files as settings: one YAML mapping with the sections and keys of settings/table.h.
//
//     const Settings settings = read_scene("scene.yaml");
//
// Numbers may be fractions (1/30). Every value keeps its line, so that later errors can name it
// (Settings::place).
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <sinew/core/capabilities.h>
#include <sinew/settings/override.h>
#include <sinew/settings/settings.h>
#include <sinew/settings/yaml_tree.h>

namespace sinew {

/// The name that the setting of a path has, which may have had another one before.
std::string present_path(const std::string& path);

/// Reads and checks a scene. An override replaces the scene's own value and removes the other key
/// of a pair (body.radius for body.count); of two overrides for one key the last applies. Paths are
/// relative to the scene, in overrides to the current directory; in the result they can be opened
/// from the current directory. Throws bad input, "FILE:LINE:COLUMN: what is wrong; what to do" or
/// "--set KEY=VALUE: ...".
Settings read_scene(const std::filesystem::path& path, std::span<const Override> overrides = {});

/// The same of a scene's text; its paths are relative to `folder`, and errors call it `name`.
Settings scene_from_text(const std::string& text, const std::string& name,
                         const std::filesystem::path& folder,
                         std::span<const Override> overrides = {});

/// The settings of a body alone: a mesh to be filled, with overrides for the sections body and
/// material; all else has its defaults. Throws bad input as read_scene() does.
Settings settings_of_mesh(const std::filesystem::path& mesh, std::span<const Override> overrides);

/// The features of a scene that the table of core/capabilities.h knows.
Features features_of(const Settings& scene);
/// Throws bad input, with the scene's line, where two of its features exclude each other, or one of
/// `more`.
void check_features(const Settings& scene, const Features& more = {});

}  // namespace sinew
