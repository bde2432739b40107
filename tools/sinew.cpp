// SPDX-License-Identifier: GPL-3.0-or-later
// sinew COMMAND ...: executes the program sinew-COMMAND in the same folder, so that each command
// loads only its own packages.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <sinew/core/text.h>
#include "command/child.h"
#include "command/command.h"
#include "command/drawing.h"
#include "command/results.h"

namespace {

using namespace sinew;

struct Known {
  std::string_view name, purpose;
};

constexpr std::array<Known, 14> commands = {{
    {"new", "write a scene for a mesh, which runs as it is"},
    {"run", "fill, simulate, render and measure a scene"},
    {"check", "report what a run needs, and doubtful settings"},
    {"fill", "fill a mesh with closest-packed particles"},
    {"simulate", "move the bones and write the motion of the body"},
    {"play", "pose a body by hand in the browser, and record it as a scene"},
    {"converge", "run a scene with particles of several sizes; limits for small ones"},
    {"sweep", "run a scene with many values of its settings; tables and a page"},
    {"measure", "write the metrics and the report of a run"},
    {"render", "draw pictures and a movie of a run"},
    {"view", "open a run in ParaView, even while it is in progress"},
    {"export", "write the particles of a run for other programs"},
    {"info", "describe a file and list its defects"},
    {"presets", "list materials by name, with their sources"},
}};

std::string usage() {
  std::string text =
      "sinew bends elastic bodies with a skeleton.\n\n"
      "Usage: sinew COMMAND [OPTIONS] ...\n\nCommands:\n";
  for (const auto& [name, purpose] : commands)
    text +=
        "  " + std::string(name) + std::string(10 - name.size(), ' ') + std::string(purpose) + '\n';
  return text +
         "\nOptions:\n  -h, --help  Show this help and exit\n"
         "  --version   Show the version and exit\n\n"
         "Examples:\n  sinew run configs/box_bend.yaml\n  sinew fill --help\n";
}

std::string name_of(const std::string& word) {
  std::vector<std::string_view> names;
  names.reserve(std::size(commands));
  for (const Known& command : commands) names.push_back(command.name);
  for (const std::string_view name : names)
    if (name == word) return word;
  const bool option = word.substr(0, 1) == "-";
  throw bad_input((option ? "unknown option " : "unknown command ") + shown(word),
                  option ? "put options behind the command; see sinew --help"
                         : suggestion(word, names) + " (see sinew --help)");
}

/// Returns only by throwing.
Exit become(const std::string& name, const std::vector<char*>& rest) {
  if (name == "render" && !draws) throw draws_nothing();
  const auto program = this_program().parent_path() / ("sinew-" + name);
  std::string path = program.string();
  std::vector<char*> arguments = {path.data()};
  arguments.insert(arguments.end(), rest.begin(), rest.end());
  arguments.push_back(nullptr);
  hold_stop_signals();
  execv(path.c_str(), arguments.data());
  throw bad_input({path}, "cannot be started (" + std::generic_category().message(errno) + ")",
                  "build or install all programs of sinew");
}

}  // namespace

int main(int argc, char** argv) {
  return run_reporting_errors([&] {
    std::vector<char*> rest(argv + std::min(argc, 2), argv + argc);
    const std::string word = argc > 1 ? argv[1] : "";
    if (word.empty()) throw bad_input("no command given", "see sinew --help");
    if (word == "--help" || word == "-h" || (word == "help" && rest.empty())) {
      print_out(usage());
      return Exit::done;
    }
    if (word == "--version") {
      print_out("sinew " + version() + '\n');
      return Exit::done;
    }
    if (word != "help") return become(name_of(word), rest);
    std::string help = "--help";
    return become(name_of(rest.front()), {help.data()});
  });
}
