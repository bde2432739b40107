// SPDX-License-Identifier: GPL-3.0-or-later
// Provides an X display, which Debian's VTK needs and without which it aborts: Xvfb, a virtual one.
//
//     ensure_display();
#pragma once

namespace sinew {

/// To be called first in a program that draws, before it has threads. Returns at once where a
/// display responds; otherwise starts Xvfb and sets DISPLAY. Xvfb ends with this process, however
/// it ends. Throws Error (not written) where Xvfb is missing or does not start.
void ensure_display();

}  // namespace sinew
