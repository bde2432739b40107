// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/display.h"

#include <X11/Xlib.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "core/error.h"

namespace sinew {
namespace {

constexpr const char* guard = "SINEW_UNDER_XVFB";  // set: xvfb-run has been tried

Error no_display(const std::string& why) {
  return Error(Exit::not_written,
               "no display to draw on: " + why + "; install one with: apt-get install xvfb xauth");
}

bool display_answers() {
  if (!std::getenv("DISPLAY")) return false;
  Display* display = XOpenDisplay(nullptr);
  if (display) XCloseDisplay(display);
  return display;
}

[[noreturn]] void restart_under_xvfb(int argc, char** argv) {
  std::vector<char*> words;
  std::string start[] = {"xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", "/proc/self/exe"};
  char self[4096] = "";
  if (readlink("/proc/self/exe", self, sizeof self - 1) > 0) start[4] = self;
  for (std::string& word : start) words.push_back(word.data());
  words.insert(words.end(), argv + 1, argv + argc);
  words.push_back(nullptr);
  setenv(guard, "1", 1);
  execvp(words[0], words.data());
  const int failed = errno;
  unsetenv(guard);
  throw no_display(std::string("xvfb-run cannot be started (") + std::strerror(failed) + ")");
}

}  // namespace

void ensure_display(int argc, char** argv) {
  const bool restarted = std::getenv(guard);
  if (restarted) prctl(PR_SET_PDEATHSIG, SIGTERM);  // xvfb-run takes the display with it
  if (display_answers()) return;
  if (restarted) throw no_display("xvfb-run gave none");
  restart_under_xvfb(argc, argv);
}

}  // namespace sinew
