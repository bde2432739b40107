// SPDX-License-Identifier: GPL-3.0-or-later
#include "command/stop_signal.h"

#include <csignal>

namespace sinew {
namespace {

volatile std::sig_atomic_t asked = 0;  // the one thing a signal handler may touch

void remember(int) { asked = 1; }

}  // namespace

void catch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stop_asked() { return asked != 0; }

}  // namespace sinew
