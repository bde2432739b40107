// SPDX-License-Identifier: GPL-3.0-or-later
// Colors, and color maps of values. Lightness increases evenly along each map, so that equal
// differences of a value appear equally large, also in gray.
//
//     const Color color = mapped_color(0.5, ColorMap::viridis);
#pragma once

#include <cstdint>
#include <optional>
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
inline constexpr Color loaded{134, 72, 178};
inline constexpr Color within{226, 106, 36};
inline constexpr Color sample{236, 120, 12};
inline constexpr Color muscle{206, 44, 48};
inline constexpr Color obstacle{128, 134, 142};
inline constexpr Color bone{44, 58, 92};
inline constexpr Color reference{250, 204, 40};
inline constexpr std::array<Color, 3> pulls{
    {{0, 108, 190}, {214, 82, 0}, {0, 150, 110}}};  // radial, twist, axial
inline constexpr std::array<Color, 3> axes{{{205, 52, 56}, {52, 150, 74}, {48, 98, 200}}};  // x y z
inline constexpr std::array<Color, 6> traces{
    {{214, 39, 40}, {31, 119, 180}, {255, 127, 14}, {148, 53, 189}, {44, 160, 44}, {227, 74, 180}}};
}  // namespace palette

/// What a picture is drawn on, and the color of the text on it.
struct Paper {
  Color background = palette::paper;
  Color ink = palette::ink;
};

/// Ink that is read on this background: dark or light.
Paper paper_of(const Color& background);

/// The color, lighter or darker where it would not stand out from the background.
Color readable_on(const Color& background, const Color& color);

/// A color that pages know by a name, as "white".
struct NamedColor {
  std::string_view name;
  Color color;
};
std::span<const NamedColor> named_colors();

/// The color of "#rrggbb", in hexadecimal digits; none for other text.
std::optional<Color> hex_color(std::string_view text);

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
