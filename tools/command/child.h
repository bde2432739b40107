// SPDX-License-Identifier: GPL-3.0-or-later
// Another program of sinew as a child that dies with its parent.
#pragma once

#include <string>
#include <vector>

namespace sinew {

// A user's wish to stop (SIGINT, SIGTERM, a terminal that is closed), to be looked at where
// stopping leaves nothing torn.

/// Whether SIGHUP was ignored when the program began, as under nohup.
bool ignores_hangup();

/// From here on SIGINT and SIGTERM only set a flag; a second one ends the program at once. So does
/// SIGHUP unless it is ignored, however often it comes.
void catch_stop_signals();

bool stop_asked();

struct ChildEnd {
  int exit = 0;        ///< its exit code; 128 + signal when a signal ended it
  std::string output;  ///< its standard output
};

/// Runs sinew-COMMAND from beside this program and waits. SIGINT and SIGTERM are passed on to it.
/// Throws bad input when it cannot be started.
ChildEnd run_child(const std::string& command, const std::vector<std::string>& arguments);

}  // namespace sinew
