// SPDX-License-Identifier: GPL-3.0-or-later
// The named view presets of pictures, and color maps and views by name.
//
//     const ViewPreset& preset = view_preset_named("body");
//     const Mat3 view = view_named("three_quarter");
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <sinew/render/camera.h>
#include <sinew/render/figure.h>

namespace sinew {

/// Stands in a preset for the array that shows deformation, as far as a run has written one.
inline constexpr std::string_view deformation = "deformation";

struct ViewPreset {
  std::string_view name;
  View view = View::both;
  bool cut_open = false;   ///< only the half of the particles away from the viewer
  std::string_view array;  ///< in color, where the user names none
  std::string_view help;
};

std::span<const ViewPreset> view_presets();

/// Throws bad input for an unknown name, suggesting the nearest.
const ViewPreset& view_preset_named(const std::string& name);
ColorMap color_map_named(const std::string& name);

/// A color by name or as `#rrggbb`, or "transparent". Throws bad input for other text.
Backdrop backdrop_named(const std::string& text);

/// How pictures look as a whole.
struct Look {
  std::string_view name, background;
  int width = 1280, height = 720;  ///< size of pictures, pixels
  double print_width = 0;          ///< mm: see PageFiles
  std::string_view help;
};

std::span<const Look> looks();
const Look& look_named(const std::string& name);

/// "three_quarter", "front", "back", "left", "right", "top", or the direction towards the viewer as
/// "1,-2,0.5". Throws bad input for anything else.
Mat3 view_named(const std::string& text);
/// Whether it is a name of a side, which goes by where a figure looks.
bool is_side(const std::string& text);

}  // namespace sinew
