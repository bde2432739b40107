// SPDX-License-Identifier: GPL-3.0-or-later
// What every program of sinew shares: its options, its exit codes, and its one line for an error.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "config/override.h"
#include "core/error.h"

namespace sinew {

/// What --help says of a command.
struct About {
  std::string name;                   ///< "fill"; the program is sinew-fill
  std::string purpose;                ///< one line
  std::vector<std::string> examples;  ///< whole command lines
  bool takes_scene = true;            ///< has --set, and --help ends with the list of settings
};

/// The options of every command.
struct Common {
  bool quiet = false;
  bool json = false;
  int threads = 0;  ///< 0: one per core
  std::vector<Override> overrides;
};

/// The main() of a command: `declare` adds its own options, `job` does the work within --threads
/// threads. Returns the exit code; what goes wrong, in the command line too, is printed as one line
/// "sinew: WHAT; CURE" on standard error.
int run_command(int argc, char** argv, const About& about,
                const std::function<void(CLI::App&)>& declare,
                const std::function<Exit(const Common&)>& job);

/// Runs `job` and returns its exit code, or that of what it throws, told as above.
int run_told(const std::function<Exit()>& job);

/// A line of talk on standard error, unless --quiet.
void say(const Common& common, const std::string& line);

/// "0.1.0"
std::string version();

}  // namespace sinew
