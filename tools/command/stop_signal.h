// SPDX-License-Identifier: GPL-3.0-or-later
// A user's wish to stop (SIGINT, SIGTERM), to be looked at where stopping leaves nothing torn.
#pragma once

namespace sinew {

/// From here on SIGINT and SIGTERM only set a flag; a second one ends the program at once.
void catch_stop_signals();

bool stop_asked();

}  // namespace sinew
