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
#include <sinew/run/run_record.h>
#include <sinew/study/compare_runs.h>
#include "command/child.h"
#include "command/command.h"
#include "command/results.h"
#include "command/sweep_runner.h"

namespace {

using namespace sinew;
namespace fs = std::filesystem;

struct Options : RunOptions {
  std::vector<double> radii;
};

fs::path folder_of_study(const Options& options) {
  if (!options.folder.empty()) return options.folder;
  fs::path folder = run_folder(options.scene, "").path;
  return folder += "_converge";
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

/// The runs, as a sweep over the radius; all their frames are kept.
Sweep sweep_of(const Options& options, const Common& common, const fs::path& folder) {
  Sweep sweep{{}, folder, {}, ""};
  sweep.file.scene = options.scene;
  sweep.file.keep = KeptFrames::all;
  for (const double radius : options.radii) {
    const std::string text = number_text(radius);
    SweepRun& run =
        sweep.runs.emplace_back(SweepRun{{text}, common.overrides, "radius_" + text, ""});
    run.overrides.push_back({"body.radius", text, "--radii"});
  }
  return sweep;
}

void refuse_used(const Sweep& sweep) {
  for (const SweepRun& run : sweep.runs)
    if (const RunFolder folder = sweep.folder_of(run); folder.used())
      throw bad_input(
          Place{folder.path.string()}, "holds a run already",
          "go on with --resume, replace it with --force, or choose another folder with -o");
}

Exit run_radii(const Sweep& sweep, const Options& options, const Common& common) {
  std::vector<Foreseen> foreseen;
  std::vector<std::size_t> numbers;
  for (const SweepRun& run : sweep.runs) {
    numbers.push_back(foreseen.size());
    foreseen.push_back(Forecast().of(settings_of(sweep, run)));
  }
  RunnerOptions how = packed(sweep, foreseen, common);
  how.together = true, how.force = options.force;
  say(common, plan_text(sweep, numbers.size(), how));
  return run_all(sweep, numbers, foreseen, how, common);
}

/// Makes the study of all.
Exit measure(const Sweep& sweep, const Common& common) {
  std::vector<std::string> words{"--study", "--threads", std::to_string(common.threads), "-o",
                                 sweep.folder.string()};
  if (common.quiet) words.push_back("--quiet");
  if (common.json) words.push_back("--json");
  words.push_back("--");
  for (const SweepRun& run : sweep.runs) words.push_back(sweep.folder_of(run).path.string());
  const ChildEnd end = run_child("measure", words);
  print_out(end.output);
  return exit_of("measure", end);
}

/// What is doubtful in any of the runs, once.
void tell_warnings(const Sweep& sweep, const Common& common) {
  std::vector<std::string> all;
  for (const SweepRun& run : sweep.runs)
    for (const std::string& warning : warnings_in(read_record(sweep.folder_of(run))))
      if (std::find(all.begin(), all.end(), warning) == all.end()) all.push_back(warning);
  print_warnings(all, common);
}

Exit converge(const Options& options, const Common& common) {
  check_radii(options.radii);
  refuse_sizes(common.overrides);
  const fs::path out = folder_of_study(options);
  refuse_folders_of_runs(out, {});
  const Sweep sweep = sweep_of(options, common, out);
  if (!options.force && !options.resume) refuse_used(sweep);
  Exit exit = run_radii(sweep, options, common);
  if (exit == Exit::done) exit = measure(sweep, common);
  if (exit == Exit::interrupted)
    say(common, "sinew: stopped; go on with the whole study by the same command and --resume");
  if (exit != Exit::done) return exit;
  tell_warnings(sweep, common);
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
