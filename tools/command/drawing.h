// SPDX-License-Identifier: GPL-3.0-or-later
// Whether these programs draw: those built with SINEW_VTK=OFF do not.
#pragma once

#include <sinew/core/error.h>

namespace sinew {

inline constexpr bool draws = SINEW_DRAWS;

/// Returns the error of what is asked to draw where nothing does.
inline Error draws_nothing() {
  return bad_input("this sinew was built without VTK, which draws",
                   "build it with -DSINEW_VTK=ON, or look at runs with: sinew view DIR");
}

}  // namespace sinew
