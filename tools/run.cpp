// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-run: fills, simulates, measures, renders and reports, each by its own program.
#include <fmt/format.h>
#include <filesystem>

#include <sinew/core/system.h>
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

Words render_words(const char* without, const Common& common, const std::string& folder) {
  Words words = shared_words(common);
  words.push_back(without);
  words.insert(words.end(), {"--", folder});
  return words;
}

Words measure_words(const Common& common, const std::string& folder) {
  Words words = shared_words(common);
  words.insert(words.end(), {"--", folder});
  return words;
}

/// The parts of a run, one after the other, with their results and times.
class Parts {
 public:
  explicit Parts(std::string folder) { results_.add("folder", folder_ = std::move(folder)); }

  /// Runs one part. It prints its own error message.
  Exit run(const std::string& command, const char* stage, const Words& words) {
    Stopwatch watch;
    const ChildEnd end = run_child(command, words);
    const double seconds = watch.lap();
    total_ += seconds;
    times_ += (times_.empty() ? "" : ", ") + std::string(stage) + ' ' + tenths(seconds);
    const auto found = nlohmann::ordered_json::parse(end.output, nullptr, false);
    if (found.is_object()) collect(found);
    for (const Exit known : {Exit::done, Exit::limit_passed, Exit::bad_input, Exit::unstable,
                             Exit::not_written, Exit::interrupted})
      if (end.exit == static_cast<int>(known)) return known;
    throw bad_input("sinew-" + command + " ended with code " + std::to_string(end.exit) +
                        (end.exit > 128 ? ", by signal " + std::to_string(end.exit - 128) : ""),
                    "see whether memory ran out; run sinew " + command + " by itself");
  }

  /// Where what people look at lies.
  void add_places(bool movie) {
    results_.add("report", folder_ + "/report.html");
    results_.add_headline("pictures", folder_ + "/pictures/contact_sheet.png");
    if (movie) results_.add_headline("movie", folder_ + "/pictures/movie.mp4");
  }

  void print(const Common& common) {
    results_.add_headline("time", tenths(total_) + " s (" + times_ + ')');
    results_.print(common);
  }

 private:
  static std::string tenths(double seconds) { return fmt::format("{:.1f}", seconds); }

  void collect(const nlohmann::ordered_json& found) {
    for (const auto& [key, value] : found.items())
      if (key != "folder" && key != "summary") results_.add(key, value);
    if (found.contains("summary"))
      for (const auto& line : found["summary"])
        if (const std::string words = line; !words.starts_with("folder: "))
          results_.add_headline("", words);
  }

  Results results_;
  std::string folder_, times_;
  double total_ = 0;  ///< s
};

/// The report includes the pictures, so they are made first; it does not wait for the movie.
Exit show(const Options& options, const Common& common, const std::string& folder, Parts& parts) {
  Exit exit = parts.run("render", "pictures", render_words("--no-movie", common, folder));
  if (exit == Exit::done) exit = parts.run("measure", "measuring", measure_words(common, folder));
  if (exit == Exit::done) parts.add_places(!options.no_movie);
  if (exit == Exit::done && !options.no_movie)
    exit = parts.run("render", "movie", render_words("--no-pictures", common, folder));
  return exit;
}

Exit run(const Options& options, const Common& common) {
  const std::string folder = run_folder(options.scene, options.folder).path.string();
  Parts parts(folder);
  Exit exit = parts.run("simulate", "simulation", simulate_words(options, common, folder));
  if (exit == Exit::done)
    exit = show(options, common, folder, parts);
  else if (exit == Exit::unstable)
    show(options, common, folder, parts);            // the frames before: they show what happened
  if (exit != Exit::bad_input) parts.print(common);  // else nothing was run
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
