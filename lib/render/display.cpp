// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/display.h"

#include <X11/Xlib.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>

#include "core/error.h"

namespace sinew {
namespace {

constexpr int not_found = 127;  // as shells say it

Error no_display(const std::string& why) {
  return Error(Exit::not_written,
               "no display to draw on: " + why + "; install it with: apt-get install xvfb");
}

/// The connection stays open while the program runs: a server whose last client leaves starts anew,
/// and refuses for that moment whom it served before.
bool display_answers() {
  static Display* connection = nullptr;
  if (!connection && std::getenv("DISPLAY")) connection = XOpenDisplay(nullptr);
  return connection;
}

/// In the child: becomes Xvfb, which looks for a free number and writes it to `report`.
[[noreturn]] void become_xvfb(pid_t parent, int report, const char* report_text) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(1);  // it died before it could be watched
  setsid();                           // Ctrl-C is for the program that draws, not for its display
  const int null = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(null, stream);
  fcntl(report, F_SETFD, 0);
  execlp("Xvfb", "Xvfb", "-displayfd", report_text, "-screen", "0", "1280x1024x24", "-nolisten",
         "tcp", static_cast<char*>(nullptr));
  _exit(errno == ENOENT ? not_found : 1);
}

/// All that can be read until the other end closes or ends a line.
std::string read_line(int file) {
  std::string line;
  for (char c = 0;;) {
    const ssize_t count = read(file, &c, 1);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0 || c == '\n') return line;
    line += c;
  }
}

/// The number of a display that dies with this process.
std::string start_xvfb() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw no_display("too many open files to start Xvfb");
  const std::string report = std::to_string(ends[1]);
  const pid_t parent = getpid(), child = fork();
  if (child == 0) become_xvfb(parent, ends[1], report.c_str());
  close(ends[1]);
  std::string number = child > 0 ? read_line(ends[0]) : "";
  close(ends[0]);
  if (!number.empty()) return number;
  int status = 0;
  if (child > 0) waitpid(child, &status, 0);
  const bool missing = WIFEXITED(status) && WEXITSTATUS(status) == not_found;
  throw no_display(missing ? "Xvfb is not installed" : "Xvfb does not start");
}

}  // namespace

void ensure_display() {
  if (display_answers()) return;
  std::string name = ":";
  name += start_xvfb();
  setenv("DISPLAY", name.c_str(), 1);
  if (!display_answers()) throw no_display("Xvfb does not answer");
}

}  // namespace sinew
