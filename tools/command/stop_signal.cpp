// SPDX-License-Identifier: GPL-3.0-or-later
#include "command/stop_signal.h"

#include <csignal>

namespace sinew {
namespace {

volatile std::sig_atomic_t asked = 0;  // the one thing a signal handler may touch

void remember(int) { asked = 1; }

}  // namespace

bool survives_its_terminal() {
  struct sigaction now {};
  return sigaction(SIGHUP, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

void catch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = remember;
  // The kernel and the shell both tell of a terminal that is closed: the second time means no more.
  if (!survives_its_terminal()) sigaction(SIGHUP, &action, nullptr);
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stop_asked() { return asked != 0; }

}  // namespace sinew
