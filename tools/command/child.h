// SPDX-License-Identifier: GPL-3.0-or-later
// Runs another program of sinew as a child that ends with its parent, and handles the signals that
// stop a run.
//
//     const ChildEnd end = run_child("simulate", {"scene.yaml"});
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sinew/core/error.h>

namespace sinew {

// Requests to stop (SIGINT, SIGTERM, a closed terminal), checked where stopping leaves all files
// complete.

/// Blocks them, also in the program that this one becomes or starts, until it says what they do.
void hold_stop_signals();

/// Makes each of them end the program at once with code 130: after `release`, which makes only
/// calls that are safe in a signal handler, and a line on standard error if it `says` so.
void end_at_stop_signals(bool says, void (*release)() = nullptr);

/// Whether another program of sinew has started this one as a part of its own work.
bool is_part_of_another();

/// Whether SIGHUP was ignored when the program began, as under nohup.
bool ignores_hangup();

/// Makes SIGPIPE only set the flag from now on: whoever reads the progress has left.
void catch_lost_reader();

/// Makes SIGINT and SIGTERM only set a flag from now on; a second one ends the program at once.
/// SIGHUP, unless ignored, also sets the flag, however often it is received.
void catch_stop_signals();

bool stop_requested();

struct ChildEnd {
  int exit = 0;        ///< its exit code; 128 + signal when a signal ended it
  std::string output;  ///< its standard output
};

/// The exit code of sinew-COMMAND, interrupted where a signal to stop ended it. Throws bad input
/// where it ended in no way that it should.
Exit exit_of(const std::string& command, const ChildEnd& end);

/// Runs sinew-COMMAND from the folder of this program and waits. SIGINT and SIGTERM are forwarded
/// to it; after one, no further child is started: it ends as interrupted. Throws bad input where it
/// cannot be started.
ChildEnd run_child(const std::string& command, const std::vector<std::string>& arguments);

/// Another program of sinew at work beside this one, until this object ends.
class Helper {
 public:
  /// `errors`: file for what it says on standard error; "": this program's. Throws bad input where
  /// it cannot be started.
  Helper(const std::string& command, const std::vector<std::string>& arguments,
         const std::string& errors = "");
  ~Helper();
  Helper(const Helper&) = delete;
  Helper& operator=(const Helper&) = delete;

  /// The next bytes of its standard output; false where it ended before.
  bool read(std::span<std::uint8_t> bytes);

  /// Its end, if it has come. What it prints is kept until then: a few kilobytes at most.
  std::optional<ChildEnd> ended();
  void end(int signal);

  /// It takes the time that other programs leave.
  void yield();
  /// Waits for its end, with the lines that it prints until then: those that `taken` takes are not
  /// among its output. Signals are forwarded to it, as by run_child.
  ChildEnd wait(const std::function<bool(const std::string& line)>& taken);

 private:
  int process_ = 0, output_ = -1;
};

}  // namespace sinew
