// SPDX-License-Identifier: GPL-3.0-or-later
// Colours, and the colour maps of values. All of them grow lighter in equal steps, so that equal
// differences of a value look equally large, also in grey.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <sinew/core/vector.h>

namespace sinew {

using Colour = std::array<std::uint8_t, 3>;  ///< sRGB red, green, blue

namespace palette {
inline constexpr Colour paper{255, 255, 255};
inline constexpr Colour ink{38, 42, 48};
inline constexpr Colour faint_ink{112, 118, 126};
}  // namespace palette

enum class ColourMap {
  indigo,  ///< indigo, teal, green, yellow; the darkest is light enough to see shading on it
  viridis,
  cividis,  ///< for eyes that do not tell red from green
  plasma,
  inferno,
  magma,
  grey,
};

struct NamedColourMap {
  std::string_view name;
  ColourMap map;
};
std::span<const NamedColourMap> colour_maps();

/// The map at 0 (low) .. 1 (high); outside and NaN: the nearer end and the low end.
Colour mapped_colour(double position, ColourMap map = ColourMap::indigo);

/// Lightness and the two opponents of a colour in Oklab (B. Ottosson, 2020), in which distances
/// are about proportional to what the eye sees.
Vec3 oklab(const Colour& colour);

}  // namespace sinew
