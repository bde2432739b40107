// SPDX-License-Identifier: GPL-3.0-or-later
// Debian's VTK draws only on an X display and aborts without one; Xvfb gives it one nobody sees.
#pragma once

namespace sinew {

/// To be called first in a program that draws, before it has threads. Returns at once where the
/// display answers; otherwise starts Xvfb and sets DISPLAY to it. That Xvfb dies with this process,
/// however it ends. Throws Error (not written) when Xvfb is missing or does not start.
void ensure_display();

}  // namespace sinew
