// SPDX-License-Identifier: GPL-3.0-or-later
// The texts that every report carries: its style, its script, and the libraries that draw.
#pragma once

#include <string_view>

namespace sinew {

std::string_view page_style();
std::string_view page_script();
std::string_view view_markup();    ///< the 3D view and its controls
std::string_view chart_library();  ///< Chart.js
std::string_view scene_library();  ///< three.js and its orbit controls
std::string_view licenses();       ///< of the libraries, plain text

}  // namespace sinew
