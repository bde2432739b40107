// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-run: fills, simulates, measures, renders and reports, each by its own program.
#include <fmt/format.h>
#include <filesystem>
#include <optional>

#include <sinew/core/json.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/run/run_folder.h>
#include <sinew/run/run_record.h>
#include "command/child.h"
#include "command/command.h"
#include "command/drawing.h"
#include "command/engine_process.h"
#include "command/progress.h"
#include "command/results.h"

namespace {

using namespace sinew;

struct Options : RunOptions {
  bool no_movie = false;
  EngineOptions engine;
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
  for (const std::string& word : words_of(options.engine)) words.push_back(word);
  if (options.force) words.push_back("--force");
  if (options.resume) words.push_back("--resume");
  words.insert(words.end(), {"-o", folder, "--", options.scene});
  return words;
}

Words picture_words(const Common& common, const std::string& folder) {
  Words words = shared_words(common);
  words.insert(words.end(), {"--no-movie", "--", folder});
  return words;
}

Words movie_words(const Common& common, const std::string& folder) {
  Words words = shared_words(common);
  words.insert(words.end(), {"--no-pictures", "--percents", "--", folder});
  return words;
}

Words measure_words(const Options& options, const Common& common, const std::string& folder) {
  Words words = shared_words(common);
  if (!options.no_movie) words.push_back("--movie-follows");
  words.insert(words.end(), {"--", folder});
  return words;
}

/// The stages of a run, one after the other, with their results and times.
class Stages {
 public:
  explicit Stages(std::string folder) { results_.add("folder", folder_ = std::move(folder)); }

  /// Runs one stage. It prints its own error message.
  Exit run(const std::string& command, const char* stage, const Words& words) {
    const ChildEnd end = run_child(command, words);
    spend(stage);
    return taken(command, end);
  }

  /// Waits for a stage that was at work beside the others, and tells its progress.
  Exit finish(Helper& helper, const std::string& command, const char* stage,
              StageProgress& progress) {
    const ChildEnd end = helper.wait([&](const std::string& line) {
      const bool percent = line.starts_with("percent ");
      if (percent) progress.at(std::stoul(line.substr(8)), 100);
      return percent;
    });
    spend(stage);
    return taken(command, end);
  }

  /// Where what people look at lies.
  void add_places(bool movie) {
    results_.add("report", folder_ + "/report.html");
    if (draws) results_.add_headline("pictures", folder_ + "/pictures/contact_sheet.png");
    if (movie) results_.add_headline("movie", folder_ + "/pictures/movie.mp4");
  }

  void print(const Common& common) {
    std::string frames;
    if (frames_ > 0) frames = "; " + three_digits(total_ / frames_) + " s per frame";
    results_.add_headline("time", tenths(total_) + " s (" + times_ + frames + ')');
    if (frames_ > 0) results_.add("seconds_per_frame", total_ / frames_);
    results_.print(common);
  }

 private:
  void spend(const char* stage) {
    const double seconds = watch_.lap();
    total_ += seconds;
    times_ += (times_.empty() ? "" : ", ") + std::string(stage) + ' ' + tenths(seconds);
  }

  Exit taken(const std::string& command, const ChildEnd& end) {
    const auto found = parsed_json<nlohmann::ordered_json>(end.output);
    if (found.is_object()) collect(found);
    return exit_of(command, end);
  }

  static std::string tenths(double seconds) { return fmt::format("{:.1f}", seconds); }

  void collect(const nlohmann::ordered_json& found) {
    if (found.contains("frames")) frames_ = found["frames"];
    for (const auto& [key, value] : found.items())
      if (key == "warnings")
        results_.add_value(key, value);
      else if (key != "folder" && key != "summary")
        results_.add(key, value);
    if (found.contains("summary"))
      for (const auto& line : found["summary"])
        if (const std::string words = line; !words.starts_with("folder: "))
          results_.add_headline("", words);
  }

  Results results_;
  std::string folder_, times_;
  Stopwatch watch_;
  double total_ = 0;  ///< s
  int frames_ = 0;
};

/// The report includes the pictures, so they are made first; it does not wait for the movie, which
/// takes the time that they leave.
Exit show(const Options& options, const Common& common, const std::string& folder, Stages& stages) {
  if (!draws) {
    say(common, "sinew: without pictures: this sinew was built without VTK");
    const Exit exit = stages.run("measure", "measuring", measure_words(options, common, folder));
    if (exit == Exit::done) stages.add_places(false);
    return exit;
  }
  StageProgress progress("movie", progress_style(common.quiet));  // counts from here
  std::optional<Helper> movie;
  if (!options.no_movie && !stop_requested()) {
    movie.emplace("render", movie_words(common, folder));
    movie->yield();
  }
  Exit exit = stages.run("render", "pictures", picture_words(common, folder));
  if (exit == Exit::done)
    exit = stages.run("measure", "measuring", measure_words(options, common, folder));
  if (exit == Exit::done) stages.add_places(!options.no_movie);
  if (exit == Exit::done && movie) exit = stages.finish(*movie, "render", "movie", progress);
  if (exit != Exit::done && movie) {
    movie.reset();
    const PicturesLock lock(RunFolder{folder}.pictures());  // tidies up
  }
  if (exit == Exit::interrupted)
    say(common,
        "sinew: stopped; the motion is complete: for pictures and report give the same "
        "command and --resume");
  return exit;
}

Exit run(const Options& options, const Common& common) {
  const std::string folder = run_folder(options.scene, options.folder).path.string();
  Stages stages(folder);
  Exit exit = stages.run("simulate", "simulation", simulate_words(options, common, folder));
  if (exit == Exit::done)
    exit = show(options, common, folder, stages);
  else if (exit == Exit::unstable)
    show(options, common, folder, stages);   // the frames before: they show what happened
  if (exit == Exit::bad_input) return exit;  // nothing was run
  stages.print(common);
  if (const RunFolder run{folder}; run.used())
    print_warnings(warnings_in(read_record(run)), common);
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
        declare(list, options.engine);
        list.add_flag("--no-movie", options.no_movie, "Pictures only");
      },
      [&](const Common& common) { return run(options, common); });
}
