// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-converge: runs a scene with particles of several sizes, and extrapolates its results to the
// body without particles.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <sinew/core/text.h>
#include <sinew/run/run_folder.h>
#include <sinew/study/compare_runs.h>
#include <sinew/study/study_files.h>
#include "command/child.h"
#include "command/command.h"
#include "command/progress.h"
#include "command/study_results.h"

namespace {

using namespace sinew;
namespace fs = std::filesystem;

struct Options : RunOptions {
  std::vector<double> radii;
};

constexpr const char* how_to_go_on =
    "sinew: stopped; go on with the whole study by the same command and --resume";

fs::path folder_of_study(const Options& options) {
  if (!options.folder.empty()) return options.folder;
  fs::path folder = run_folder(options.scene, "").path;
  return folder += "_converge";
}

fs::path folder_of(const fs::path& study, double radius) {
  return study / ("radius_" + number_text(radius));
}

void check_radii(const std::vector<double>& radii) {
  for (const double radius : radii)
    if (!(radius > 0) || !std::isfinite(radius))
      throw bad_input("--radii has " + number_text(radius), "give radii above 0, in meters");
  std::vector<double> sorted = radii;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    throw bad_input("--radii has a radius twice", "give each radius once");
  if (sorted.size() < 2)
    throw bad_input("--radii has one radius",
                    "give two radii, or better three, as in 0.02,0.014,0.01");
}

/// Which are this command's to choose.
void refuse_sizes(const std::vector<Override>& overrides) {
  for (const Override& override : overrides)
    for (const char* key : {"body.radius", "body.count"})
      if (override.path == key)
        throw bad_input("--set " + override.path + " beside --radii",
                        "leave it out: each run gets its radius from --radii");
}

std::vector<std::string> words_for(const Options& options, const Common& common,
                                   const fs::path& folder, double radius) {
  std::vector<std::string> words{"--json", "--threads", std::to_string(common.threads)};
  if (common.quiet) words.push_back("--quiet");
  for (const Override& override : common.overrides)
    words.insert(words.end(), {"--set", override.path + '=' + override.value});
  words.insert(words.end(), {"--set", "body.radius=" + number_text(radius)});
  if (options.force) words.push_back("--force");
  if (options.resume && RunFolder{folder}.used()) words.push_back("--resume");
  words.insert(words.end(), {"-o", folder.string(), "--", options.scene});
  return words;
}

void refuse_used(const Options& options, const fs::path& study) {
  if (options.force || options.resume) return;
  for (const double radius : options.radii)
    if (const fs::path folder = folder_of(study, radius); RunFolder{folder}.used())
      throw bad_input(
          Place{folder.string()}, "holds a run already",
          "go on with --resume, replace it with --force, or choose another folder with -o");
}

/// The coarsest first: what is wrong with the scene is told soon.
Exit run_all(const Options& options, const Common& common, const fs::path& study,
             std::vector<double> radii) {
  std::sort(radii.rbegin(), radii.rend());
  for (const double radius : radii) {
    const fs::path folder = folder_of(study, radius);
    say(common, "radius " + number_text(radius) + " m:");
    const ChildEnd end = run_child("simulate", words_for(options, common, folder, radius));
    const Exit exit = exit_of("simulate", end);
    if (exit == Exit::interrupted) say(common, how_to_go_on);
    if (exit != Exit::done) return exit;
  }
  return Exit::done;
}

Exit converge(const Options& options, const Common& common) {
  check_radii(options.radii);
  refuse_sizes(common.overrides);
  const fs::path out = folder_of_study(options);
  refuse_folders_of_runs(out, {});
  refuse_used(options, out);
  const Exit exit = run_all(options, common, out, options.radii);
  if (exit != Exit::done) return exit;
  std::vector<fs::path> folders;
  for (const double radius : options.radii) folders.push_back(folder_of(out, radius));
  StageProgress progress("measuring", progress_style(common.quiet));
  MeasureOptions how;
  how.ahead = common.threads != 1;
  how.progress = [&](std::size_t done, std::size_t of) {
    if (stop_requested()) throw Error(Exit::interrupted, std::string(how_to_go_on).substr(7));
    progress.at(done, of);
  };
  const Study study = study_runs(folders, how);
  write_study(study, out);
  print_study(study, out, common);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return run_command(
      argc, argv,
      {"converge",
       "Runs a scene with particles of several sizes and extrapolates its metrics, supports, loads "
       "and probes to size 0: study.csv, study.json, report.html.",
       {"sinew converge configs/bar_pull.yaml --radii 0.014,0.012,0.010",
        "sinew converge configs/bar_pull.yaml --radii 0.014,0.012,0.010 --resume"}},
      [&](OptionList& list) {
        declare(list, options);
        list.add("--radii", options.radii, "Radii of the particles (m)")
            .type_name("R,R,...")
            .comma_separated()
            .required();
      },
      [&](const Common& common) { return converge(options, common); });
}
