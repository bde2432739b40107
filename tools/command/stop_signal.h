// SPDX-License-Identifier: GPL-3.0-or-later
// A user's wish to stop (SIGINT, SIGTERM, a terminal that is closed), to be looked at where stopping
// leaves nothing torn.
#pragma once

namespace sinew {

/// Whether SIGHUP was ignored when the program began, as under nohup.
bool survives_its_terminal();

/// From here on SIGINT and SIGTERM only set a flag; a second one ends the program at once. So does
/// SIGHUP unless it is ignored, however often it comes.
void catch_stop_signals();

bool stop_asked();

}  // namespace sinew
