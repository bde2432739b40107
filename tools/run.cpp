// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-run: fills, simulates, measures, renders and reports, each by its own program.
#include <filesystem>

#include <sinew/run/run_folder.h>
#include "command/child.h"
#include "command/command.h"
#include "command/results.h"

namespace {

using namespace sinew;

struct Options : RunOptions {
  bool no_movie = false;
};

using Words = std::vector<std::string>;

Words shared_words(const Common& common) {
  Words words{"--json", "--threads", std::to_string(common.threads)};
  if (common.quiet) words.push_back("--quiet");
  return words;
}

Words simulate_words(const Options& options, const Common& common, const std::string& folder) {
  Words words = shared_words(common);
  words.insert(words.end(), {"--invoked-as", "run"});
  for (const Override& override : common.overrides)
    words.insert(words.end(), {"--set", override.path + '=' + override.value});
  if (options.force) words.push_back("--force");
  if (options.resume) words.push_back("--resume");
  words.insert(words.end(), {"-o", folder, "--", options.scene});
  return words;
}

Words render_words(const Options& options, const Common& common, const std::string& folder) {
  Words words = shared_words(common);
  if (options.no_movie) words.push_back("--no-movie");
  words.insert(words.end(), {"--", folder});
  return words;
}

Words measure_words(const Common& common, const std::string& folder) {
  Words words = shared_words(common);
  words.insert(words.end(), {"--", folder});
  return words;
}

/// Runs one part and collects its results. It prints its own error message.
Exit do_part(const std::string& command, const Words& words, Results& results) {
  const ChildEnd end = run_child(command, words);
  const auto found = nlohmann::ordered_json::parse(end.output, nullptr, false);
  if (found.is_object())
    for (const auto& [key, value] : found.items())
      if (key != "folder") results.add(key, value);
  for (const Exit known : {Exit::done, Exit::limit_passed, Exit::bad_input, Exit::unstable,
                           Exit::not_written, Exit::interrupted})
    if (end.exit == static_cast<int>(known)) return known;
  throw bad_input("sinew-" + command + " ended with code " + std::to_string(end.exit) +
                      (end.exit > 128 ? ", by signal " + std::to_string(end.exit - 128) : ""),
                  "see whether memory ran out; run sinew " + command + " by itself");
}

Exit run(const Options& options, const Common& common) {
  const std::string folder = run_folder(options.scene, options.folder).path.string();
  Results results;
  results.add("folder", folder);
  Exit exit = do_part("simulate", simulate_words(options, common, folder), results);
  // The report includes the pictures, so they are made first.
  if (exit == Exit::done) exit = do_part("render", render_words(options, common, folder), results);
  if (exit == Exit::done) exit = do_part("measure", measure_words(common, folder), results);
  if (exit == Exit::done) results.add("report", folder + "/report.html");
  if (exit != Exit::bad_input) results.print(common.json);  // else nothing was run
  return exit;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return run_command(
      argc, argv,
      {"run",
       "Fills, simulates, renders and measures a scene.",
       {"sinew run configs/box_bend.yaml",
        "sinew run configs/box_bend.yaml -o /tmp/soft --set body.radius=0.014"}},
      [&](OptionList& list) {
        declare(list, options);
        list.add_flag("--no-movie", options.no_movie, "Pictures only");
      },
      [&](const Common& common) { return run(options, common); });
}
