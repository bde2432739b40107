// SPDX-License-Identifier: GPL-3.0-or-later
// Colours, and the colour map of the particles: indigo, teal, green, yellow, growing lighter in
// equal steps, so that equal differences of a value look equally large, also in grey.
#pragma once

#include <cstdint>

#include "core/vector.h"

namespace sinew {

using Colour = std::array<std::uint8_t, 3>;  ///< sRGB red, green, blue

namespace palette {
inline constexpr Colour paper{255, 255, 255};
inline constexpr Colour ink{38, 42, 48};
inline constexpr Colour faint_ink{112, 118, 126};
}  // namespace palette

/// The map at 0 (low) .. 1 (high); outside and NaN: the nearer end and the low end.
Colour mapped_colour(double position);

/// Lightness and the two opponents of a colour in Oklab (B. Ottosson, 2020), in which distances
/// are about proportional to what the eye sees.
Vec3 oklab(const Colour& colour);

}  // namespace sinew
