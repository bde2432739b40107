// SPDX-License-Identifier: GPL-3.0-or-later
// Debian's VTK draws only on an X display and aborts without one; xvfb gives it one nobody sees.
#pragma once

namespace sinew {

/// To be called first in a program that draws. Returns at once where the display answers; otherwise
/// starts the program again under xvfb-run, with the same arguments. Throws Error (not written)
/// when xvfb-run is missing or gives no display either.
void ensure_display(int argc, char** argv);

}  // namespace sinew
