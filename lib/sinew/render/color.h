// SPDX-License-Identifier: GPL-3.0-or-later
// Colors, and color maps of values. Lightness increases evenly along each map, so that equal
// differences of a value appear equally large, also in gray.
//
//     const Color color = mapped_color(0.5, ColorMap::viridis);
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <sinew/core/vector.h>

namespace sinew {

using Color = std::array<std::uint8_t, 3>;  ///< sRGB red, green, blue

namespace palette {
inline constexpr Color paper{255, 255, 255};
inline constexpr Color no_value{158, 158, 158};
inline constexpr Color ink{38, 42, 48};
inline constexpr Color faint_ink{112, 118, 126};
inline constexpr Color particle{206, 164, 138};  ///< without a value
inline constexpr Color held{30, 34, 40};
inline constexpr Color sample{236, 120, 12};
inline constexpr Color muscle{206, 44, 48};
inline constexpr Color obstacle{128, 134, 142};
inline constexpr Color bone{44, 58, 92};
}  // namespace palette

enum class ColorMap {
  indigo,  ///< indigo, teal, green, yellow; the darkest is light enough to see shading on it
  viridis,
  cividis,  ///< for color vision without red and green
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

/// The map at 0 (low) .. 1 (high); the nearer end outside of that, gray for NaN.
Color mapped_color(double position, ColorMap map = ColorMap::indigo);

/// Lightness and the two opponent channels of a color in Oklab (B. Ottosson, 2020), in which
/// distances are about proportional to perceived differences.
Vec3 oklab(const Color& color);

}  // namespace sinew
