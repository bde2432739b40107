// SPDX-License-Identifier: GPL-3.0-or-later
// What lies in the regions of space that a part names, and which faces look where it says.
//
//     if (is_in_region(part, place) && faces_as(part, area, center)) found.push_back(face);
#pragma once

#include <sinew/settings/settings.h>

namespace sinew {

/// Whether a place (m) at rest is in the box, the ball, in front of the plane and around the axis
/// of a part, as far as it has them; `slack` (m) widens them.
bool is_in_region(const PartSettings& part, const Vec3& place, double slack = 0);

/// Whether a face at rest looks where a part asks for: `area` is its normal, of any length, and
/// `center` (m) a point on it.
bool faces_as(const PartSettings& part, const Vec3& area, const Vec3& center);

}  // namespace sinew
