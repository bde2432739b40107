// SPDX-License-Identifier: GPL-3.0-or-later
// The ways of looking at a run that pictures can be asked for by name.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <sinew/render/camera.h>
#include <sinew/render/picture.h>

namespace sinew {

struct ViewPreset {
  std::string_view name;
  View view = View::both;
  bool cut_open = false;   ///< only the half of the particles away from the viewer
  std::string_view array;  ///< in color, where the user names none
  std::string_view help;
};

std::span<const ViewPreset> view_presets();

/// Throws bad input, with the nearest, for an unknown name.
const ViewPreset& view_preset_named(const std::string& name);
ColorMap color_map_named(const std::string& name);

/// "three_quarter", "front", "back", "left", "right", "top", or the direction towards the viewer as
/// "1,-2,0.5". Throws bad input for anything else.
Mat3 view_named(const std::string& text);

}  // namespace sinew
