// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-measure: metrics.csv, metrics_bones.csv, sections.csv, metrics.json and report.html of a
// run; a comparison of two runs; a study of more.
#include <algorithm>
#include <cmath>

#include <sinew/core/arrays.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/metrics/table.h>
#include <sinew/run/report_input.h>
#include <sinew/run/run_record.h>
#include <sinew/study/compare_elements.h>
#include <sinew/study/compare_runs.h>
#include <sinew/study/study_files.h>
#include "command/command.h"
#include "command/progress.h"
#include "command/results.h"
#include "command/study_results.h"

namespace {

using namespace sinew;

constexpr int max_runs = 1000;

struct Options {
  std::vector<std::string> folders;
  std::vector<std::string> limits;
  std::string reference, arrays, out;
  bool movie_follows = false;  ///< part of sinew run, which draws the movie last
};

void declare(OptionList& list, Options& options) {
  list.add("DIR", options.folders, "Folder of the run, or folders of runs to compare")
      .required()
      .expected(1, max_runs);
  list.add("-o", options.out, "Folder for the comparison of several runs").type_name("DIR");
  list.add("--fail-on", options.limits,
           "Exit with code 1 if this holds in any frame, such as 'volume_error > 0.05'; for "
           "two runs a metric is the second's minus the first's")
      .type_name("LIMIT")
      .repeatable();
  list.add("--reference", options.reference,
           "Also measure the distance to the surfaces of this series (VTU or VTP in the PVD's "
           "folder or below, one file for each time); or compare with this result "
           "of finite elements")
      .type_name("FILE.pvd|FILE.frd");
  list.add("--arrays", options.arrays,
           "Also write these arrays of every particle and frame, as values.pvd: F, J, "
           "stress, ...; all")
      .type_name("NAMES");
  list.add_flag("--movie-follows", options.movie_follows, "").group("");
}

double worst_of(const Measured& measured, const Metric& metric, const MetricSummary& summary) {
  return summary.worst_frame ? measured.frames[*summary.worst_frame].*metric.value : not_measured;
}

/// How well the body follows its bones, in a few lines.
void add_verdicts(const Measured& measured, const RunFiles& run, Results& results) {
  const auto worst = [&](std::string_view name, double& time) {
    const auto metrics = metrics_table();
    for (std::size_t i = 1; i < metrics.size(); ++i)
      if (metrics[i].name == name) {
        const MetricSummary& summary = measured.summary.metrics[i];
        if (summary.worst_frame) time = measured.frames[*summary.worst_frame].time;
        return worst_of(measured, metrics[i], summary);
      }
    return not_measured;
  };
  const auto add = [&](std::string_view name, const std::string& key, const std::string& unit) {
    double time = 0;
    const double value = worst(name, time);
    if (std::isfinite(value))
      results.add_headline(key, three_digits(value) + unit +
                                    (value == 0 ? "" : ", at " + three_digits(time) + " s"));
  };
  add("bone_angle", "bone_angle", " degrees");
  add("volume_error", "volume_error", " of the volume at rest");
  add("inverted", "inverted", " of " + std::to_string(run.body.particles.size()) + " particles");
  add("pose_error_rms", "pose_error", " m rms from the bones' rigid pose");
  add("self_intersections", "self_intersections", " pairs of faces");
}

void print_results(const Measured& measured, const RunFiles& run, const Common& common) {
  Results results;
  results.add("frames", measured.frames.size());
  const auto metrics = metrics_table();
  for (std::size_t i = 1; i < metrics.size(); ++i) {
    const double worst = worst_of(measured, metrics[i], measured.summary.metrics[i]);
    results.add("worst_" + std::string(metrics[i].name), worst, std::string(metrics[i].unit));
  }
  for (const RunMetric& metric : run_metrics_table())
    results.add(std::string(metric.name), measured.summary.*metric.value, std::string(metric.unit));
  add_verdicts(measured, run, results);
  results.add_headline("report", (run.folder.path / "report.html").string());
  results.print(common);
}

/// Reports limits that were exceeded one by one.
Exit exit_after(const std::vector<Check>& checks) {
  Exit exit = Exit::done;
  for (const Check& check : checks) {
    if (check.pass) continue;
    print_error("sinew: " + describe(check));
    exit = Exit::limit_passed;
  }
  return exit;
}

MeasureOptions how_to_measure(const Options& options, const Common& common) {
  MeasureOptions how;
  for (const std::string& text : options.limits) how.limits.push_back(parse_limit(text));
  if (!options.reference.empty()) how.reference = open_surfaces(options.reference);
  how.arrays = requested_arrays(options.arrays);
  if (!how.arrays.stepped.empty() && !how.arrays.all)
    throw bad_input("a run's files do not give " + std::string(how.arrays.stepped.front()) +
                        ", which follows from the forces of its moment",
                    "let the run write it: output.arrays");
  how.ahead = common.threads != 1;
  return how;
}

Exit measure_folder(const Options& options, const Common& common) {
  if (!options.out.empty())
    throw bad_input("-o is for the comparison of several runs",
                    "leave it out, or name two runs or more");
  StageProgress progress("measuring", progress_style(common.quiet));
  MeasureOptions how = how_to_measure(options, common);
  how.progress = [&](std::size_t done, std::size_t of) { progress.at(done, of); };
  Stopwatch watch;
  const RunFiles run = open_run({options.folders.front()});
  if (run.frames() < run.frames_named)
    say(common,
        "warning: only " + std::to_string(run.frames()) + " of " +
            std::to_string(run.frames_named) +
            " frames are in all series (a run in progress, or interrupted); these are measured");
  Measured measured = measure_run(run, how);
  write_tables(run, measured);
  record_stage(run.folder, "measuring", watch.lap());
  print_results(measured, run, common);
  if (const std::string reasons = reasons_for_distrust(
          measured.frames, measured.summary, run.body.particles.radius, run.body.particles.size());
      !reasons.empty())
    say(common, "warning: this run is not to be trusted: at its worst, " + reasons);
  const Exit exit = exit_after(measured.checks);
  const MovieLink movie = options.movie_follows ? MovieLink::follows : MovieLink::if_there;
  write_report(run, std::move(measured), movie);
  return exit;
}

/// The largest differences.
void print_comparison(const RunComparison& compared, const Common& common) {
  Results results;
  results.add("frames", compared.differences.size());
  if (!compared.remarks.empty()) results.add("remarks", compared.remarks);
  if (compared.speedup) results.add("speedup", *compared.speedup);
  const auto metrics = metrics_table();
  for (std::size_t i = 1; i < metrics.size(); ++i) {
    const auto largest = largest_difference(compared, i);
    if (!largest) continue;
    const std::string name(metrics[i].name);
    results.add(is_distance(name) ? name : name + "_difference",
                compared.differences[*largest].*metrics[i].value, std::string(metrics[i].unit));
  }
  results.print(common);
}

Exit compare_folders(const Options& options, const Common& common) {
  if (options.out.empty())
    throw bad_input("two runs are compared into a folder of its own", "name it with -o");
  if (!options.reference.empty() || !options.arrays.empty())
    throw bad_input("--reference and --arrays are for one run: of two, the first is the reference",
                    "leave them out");
  const RunComparison comparison = compare_runs(options.folders[0], options.folders[1],
                                                how_to_measure(options, common), options.out);
  print_comparison(comparison, common);
  return exit_after(comparison.checks);
}

bool names_elements(const std::string& reference) {
  return lower(std::filesystem::path(reference).extension().string()) == ".frd";
}

void print_elements(const ElementComparison& compared, const std::filesystem::path& out,
                    const Common& common) {
  const auto farthest = std::max_element(
      compared.frames.begin(), compared.frames.end(),
      [](const ElementFrame& a, const ElementFrame& b) { return a.max_relative < b.max_relative; });
  Results results;
  results.add("elements", compared.elements);
  results.add("particles", compared.particles);
  results.add("frames", compared.frames.size());
  for (const ElementColumn& column : element_columns())
    results.add(std::string(column.name), (*farthest).*column.value, std::string(column.unit));
  const auto percent = [](double value) { return three_digits(100 * value) + " %"; };
  results.add_headline("difference", percent(farthest->rms_relative) + " rms, " +
                                         percent(farthest->max_relative) +
                                         " at most, of the largest displacement, at " +
                                         three_digits(farthest->time) + " s");
  results.add_headline("report", (out / "report.html").string());
  results.print(common);
}

/// Into -o, by default a folder beside the run.
Exit compare_with_elements(const Options& options, const Common& common) {
  if (!options.arrays.empty())
    throw bad_input("--arrays is not for a comparison with finite elements", "leave it out");
  const std::filesystem::path run = options.folders.front();
  const std::filesystem::path out = options.out.empty()
                                        ? run.parent_path() / (name_of_run(run) + "_reference")
                                        : std::filesystem::path(options.out);
  StageProgress progress("measuring", progress_style(common.quiet));
  MeasureOptions how;
  for (const std::string& text : options.limits) how.limits.push_back(parse_limit(text));
  how.progress = [&](std::size_t done, std::size_t of) { progress.at(done, of); };
  const ElementComparison compared = compare_elements(run, options.reference, how, out);
  print_elements(compared, out, common);
  return exit_after(compared.metrics.checks);
}

Exit study_folders(const Options& options, const Common& common) {
  if (options.out.empty())
    throw bad_input("several runs are compared into a folder of its own", "name it with -o");
  if (!options.arrays.empty() || !options.limits.empty())
    throw bad_input("--arrays and --fail-on are for one or two runs", "leave them out");
  const std::vector<std::filesystem::path> folders(options.folders.begin(), options.folders.end());
  refuse_folders_of_runs(options.out, folders);
  StageProgress progress("measuring", progress_style(common.quiet));
  MeasureOptions how = how_to_measure(options, common);
  how.progress = [&](std::size_t done, std::size_t of) { progress.at(done, of); };
  const Study study = study_runs(folders, how);
  write_study(study, options.out);
  print_study(study, options.out, common);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  About about{
      "measure",
      "Measures a run: metrics.csv, metrics_bones.csv, sections.csv, metrics.json, report.html. "
      "Compares two runs: compare.csv, metrics.json, report.html; and more: study.csv, study.json, "
      "report.html.",
      {"sinew measure out/box_bend", "sinew measure out/box_bend --fail-on 'volume_error > 0.05'",
       "sinew measure out/paper out/bonded -o out/paper_bonded",
       "sinew measure out/soft out/middle out/stiff -o out/stiffness",
       "sinew measure out/coarse --reference out/fine/surface.pvd",
       "sinew measure out/beam --reference beam.frd",
       "sinew measure out/box_bend --arrays 'J, strain, stress'"}};
  about.takes_scene = false;
  return run_command(
      argc, argv, about, [&](OptionList& list) { declare(list, options); },
      [&](const Common& common) {
        if (options.folders.size() > 2) return study_folders(options, common);
        if (options.folders.size() == 1 && names_elements(options.reference))
          return compare_with_elements(options, common);
        return options.folders.size() == 2 ? compare_folders(options, common)
                                           : measure_folder(options, common);
      });
}
