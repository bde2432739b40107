// SPDX-License-Identifier: GPL-3.0-or-later
// Colors, and the color maps of values. All of them grow lighter in equal steps, so that equal
// differences of a value look equally large, also in gray.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <sinew/core/vector.h>

namespace sinew {

using Color = std::array<std::uint8_t, 3>;  ///< sRGB red, green, blue

namespace palette {
inline constexpr Color paper{255, 255, 255};
inline constexpr Color ink{38, 42, 48};
inline constexpr Color faint_ink{112, 118, 126};
}  // namespace palette

enum class ColorMap {
  indigo,  ///< indigo, teal, green, yellow; the darkest is light enough to see shading on it
  viridis,
  cividis,  ///< for eyes that do not tell red from green
  plasma,
  inferno,
  magma,
  gray,
};

struct NamedColorMap {
  std::string_view name;
  ColorMap map;
};
std::span<const NamedColorMap> color_maps();

/// The map at 0 (low) .. 1 (high); outside and NaN: the nearer end and the low end.
Color mapped_color(double position, ColorMap map = ColorMap::indigo);

/// Lightness and the two opponents of a color in Oklab (B. Ottosson, 2020), in which distances
/// are about proportional to what the eye sees.
Vec3 oklab(const Color& color);

}  // namespace sinew
