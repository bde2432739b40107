// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/display/display.h>

#include <X11/Xlib.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cerrno>
#include <cstdlib>
#include <string>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr int not_found = 127;  // exit code, as in shells

Error no_display(const std::string& why) {
  return Error(Exit::not_written,
               "no display to draw on: " + why + "; install it with: apt-get install xvfb");
}

/// The connection stays open while the program runs: another's server may reset when its last
/// client disconnects, and meanwhile refuse connections.
bool display_answers() {
  static Display* connection = nullptr;
  if (!connection && std::getenv("DISPLAY")) connection = XOpenDisplay(nullptr);
  return connection;
}

/// In the child: becomes the display `name` and writes to `report` when it is ready.
[[noreturn]] void become_xvfb(pid_t parent, const char* name, int report, const char* report_text) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(1);  // the parent ended before it could be watched
  setsid();                           // Ctrl-C must reach the drawing program, not the display
  const int null = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(null, stream);
  fcntl(report, F_SETFD, 0);
  // Without -noreset a server whose last client disconnects resets, and meanwhile refuses
  // connections: a program that opens one display after another, as ParaView does, would abort.
  execlp("Xvfb", "Xvfb", name, "-displayfd", report_text, "-noreset", "-screen", "0",
         "1280x1024x24", "-nolisten", "tcp", static_cast<char*>(nullptr));
  _exit(errno == ENOENT ? not_found : 1);
}

/// Whether a whole line is received before the other end closes.
bool line_comes(int file) {
  char byte = 0;
  ssize_t count = 0;
  do count = read(file, &byte, 1);
  while ((count < 0 && errno == EINTR) || (count > 0 && byte != '\n'));
  return count > 0;
}

/// Starts a display of that name, which ends with this process; returns whether it is ready.
bool start_xvfb(const std::string& name) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw no_display("too many open files to start Xvfb");
  const std::string report = std::to_string(ends[1]);
  const pid_t parent = getpid(), child = fork();
  if (child == 0) become_xvfb(parent, name.c_str(), ends[1], report.c_str());
  close(ends[1]);
  const bool ready = child > 0 && line_comes(ends[0]);
  close(ends[0]);
  if (ready) return true;
  int status = 0;
  if (child > 0) waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == not_found)
    throw no_display("Xvfb is not installed");
  return false;
}

/// OpenGL's libraries and threads reserve addresses, and crash where there are too few.
void check_addresses() {
  constexpr double needed = 950e6;
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  if (static_cast<double>(limit.rlim_cur) < needed)
    throw bad_input("drawing needs an address space of " + bytes_text(needed) +
                        ", and ulimit -v allows " + bytes_text(static_cast<double>(limit.rlim_cur)),
                    "raise it: ulimit -v unlimited");
}

}  // namespace

void ensure_display() {
  check_addresses();
  if (display_answers()) return;
  for (int attempt = 0; attempt < 5; ++attempt) {
    // Not the first free number: a display that is just ending there would take over the socket.
    std::string name = ":";
    name += std::to_string(100 + (getpid() + 7919 * attempt) % 50000);
    if (!start_xvfb(name)) continue;
    setenv("DISPLAY", name.c_str(), 1);
    if (display_answers()) return;
  }
  throw no_display("Xvfb does not start");
}

}  // namespace sinew
