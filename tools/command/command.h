// SPDX-License-Identifier: GPL-3.0-or-later
// The common part of all programs of sinew: options, exit codes, and the one-line error message.
//
//     int main(int argc, char** argv) { return run_command(argc, argv, about, declare, job); }
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/system.h>
#include <sinew/settings/read_scene.h>
#include "command/option_list.h"

namespace sinew {

/// Description of a command for --help.
struct About {
  std::string name;                   ///< "fill"; the program is sinew-fill
  std::string purpose;                ///< one line
  std::vector<std::string> examples;  ///< complete command lines
  bool takes_scene = true;            ///< has --set and --help-settings
};

/// The options of every command.
struct Common {
  bool quiet = false;
  bool json = false, verbose = false;
  int threads = 0;  ///< 0: one per core
  std::vector<Override> overrides;
};

/// The main() of a command: `declare` adds its own options, `job` does the work in --threads
/// threads. Returns the exit code; an error, also in the command line, is printed as one line
/// "sinew: WHAT; CURE" on standard error.
int run_command(int argc, char** argv, const About& about,
                const std::function<void(OptionList&)>& declare,
                const std::function<Exit(const Common&)>& job);

/// Opens /dev/null as standard input, output and error where they are closed, as daemons may leave
/// them: files opened later would get their numbers, and messages would be written into them.
void open_standard_streams();

/// Runs `job` and returns its exit code, or that of the error it throws, reported as above.
int run_reporting_errors(const std::function<Exit()>& job);

/// Prints a message on standard error, unless --quiet.
void say(const Common& common, const std::string& line);

// The common options of `run` and `simulate`.

struct RunOptions {
  std::string scene, folder;
  bool force = false, resume = false;
  std::string invoked_as = "simulate";  ///< the command that the user called, to be named in hints
};

inline void declare(OptionList& list, RunOptions& options) {
  list.add("SCENE", options.scene, "Scene file (YAML)").required();
  list.add("-o", options.folder, "Folder of the run; by default out/NAME-OF-SCENE")
      .type_name("DIR");
  const CommandOption force =
      list.add_flag("--force", options.force, "Replace an older run in the folder");
  list.add_flag("--resume", options.resume, "Continue a run that was stopped").excludes(force);
  // Passed by run to simulate; in no help.
  list.add("--invoked-as", options.invoked_as).group("");
}

}  // namespace sinew
