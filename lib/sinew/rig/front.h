// SPDX-License-Identifier: GPL-3.0-or-later
// Where a figure looks: by its feet and by the names of what it has on the left and on the right.
//
//     if (const auto front = front_of(names, heads, tails)) camera = view_from(*front);
#pragma once

#include <optional>
#include <span>
#include <string>

#include <sinew/core/vector.h>

namespace sinew {

/// Horizontal (z is up), of length 1; none where names tell no sides and no feet. `heads` and
/// `tails` of the bones, m. Names have "left" and "right", or L and R as a word, in front or at the
/// end; digits do not count.
std::optional<Vec3> front_of(std::span<const std::string> names, const Points& heads,
                             const Points& tails);

}  // namespace sinew
