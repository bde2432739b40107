// SPDX-License-Identifier: GPL-3.0-or-later
// A scene file as settings: one YAML mapping with the sections and keys of core/settings_table.h.
//
// Numbers may be written as fractions (1/30). Every value knows its line, so that whoever finds it
// wrong later can name it (Settings::place).
#pragma once

#include <filesystem>
#include <span>

#include "config/override.h"
#include "core/settings.h"

namespace sinew {

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
