// SPDX-License-Identifier: GPL-3.0-or-later
// How some particles move, nearly, and how far they extend: from sums that the kernel makes.
#pragma once

#include <cstddef>

#include <sinew/core/vector.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/near_pieces.h>

namespace sinew {

/// Their rigid velocity field by least squares, and boxes around them. The survey is relative to
/// `center` and along `axes`, and rounded by that fraction of its extent.
PieceNow motion_of(const kernel::Survey& survey, std::size_t particles, const Vec3& center,
                   const Mat3& axes, double rounding);

/// Axes along which they extend: columns.
Mat3 axes_of(const kernel::Survey& survey, std::size_t particles);

}  // namespace sinew
