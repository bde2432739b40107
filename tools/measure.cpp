// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-measure: metrics.csv, metrics_bones.csv, sections.csv, metrics.json and report.html of a
// run; a comparison of two runs; a study of more.
#include <algorithm>
#include <cmath>
#include <map>

#include <sinew/core/arrays.h>
#include <sinew/core/file.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/metrics/table.h>
#include <sinew/run/report_input.h>
#include <sinew/run/run_record.h>
#include <sinew/study/compare_elements.h>
#include <sinew/study/compare_runs.h>
#include <sinew/study/study_files.h>
#include <sinew/study/sweep/baseline.h>
#include "command/command.h"
#include "command/progress.h"
#include "command/results.h"

namespace {

using namespace sinew;

constexpr int max_runs = 1000;

struct Options {
  std::vector<std::string> folders;
  std::vector<std::string> limits;
  std::string reference, arrays, out, baseline, new_baseline;
  bool movie_follows = false;  ///< part of sinew run, which draws the movie last
  bool study = false;          ///< part of sinew converge: two runs are a study as well
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
  list.add("--baseline", options.baseline,
           "Exit with code 1 if results differ from this recorded table by more than it allows")
      .type_name("FILE.csv");
  list.add("--write-baseline", options.new_baseline,
           "Record the results and their tolerances, to be edited")
      .type_name("FILE.csv");
  list.add_flag("--movie-follows", options.movie_follows, "").group("");
  list.add_flag("--study", options.study, "").group("");
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

/// Tells all results that are not as recorded, in one table.
Exit exit_after_baseline(const Options& options, const Common& common) {
  const std::filesystem::path run = options.folders.front();
  if (!options.new_baseline.empty()) {
    refuse_file_of_run(options.new_baseline);
    write_file(options.new_baseline, baseline_csv(run));
    say(common, "sinew: recorded the results in " + options.new_baseline);
  }
  if (options.baseline.empty()) return Exit::done;
  const std::vector<Difference> found = compare_with_baseline(run, options.baseline);
  if (found.empty()) return Exit::done;
  print_error("sinew: " + std::to_string(found.size()) + " results are not as in " +
              options.baseline + ":");
  const auto text = [](double value) {
    return std::isnan(value) ? std::string("not there") : number_text(value);
  };
  for (const Difference& one : found)
    print_error("  " + one.name + ", " + one.of + ": " + text(one.now) + ", recorded " +
                text(one.before) + ", may differ by " + three_digits(one.allowed));
  return Exit::limit_passed;
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
  record_stage(run.folder, "measuring", watch.lap(), {measured.ranges, run.frames_run});
  renew_view(run.folder, run.ranges);
  print_results(measured, run, common);
  if (const std::string reasons = reasons_for_distrust(
          measured.frames, measured.summary, run.body.particles.radius, run.body.particles.size());
      !reasons.empty())
    say(common, "warning: this run is not to be trusted: at its worst, " + reasons);
  Exit exit = exit_after(measured.checks);
  const MovieLink movie = options.movie_follows ? MovieLink::follows : MovieLink::if_there;
  write_report(run, std::move(measured), movie);
  if (exit_after_baseline(options, common) != Exit::done) exit = Exit::limit_passed;
  return exit;
}

/// A metric in the frame where two runs differ most in it.
struct Differing {
  const Metric* metric;
  std::size_t frame;
  double part;  ///< difference over the metric's largest value in either run
};

/// The metrics of which two runs differ most; without rounding beside others of the same unit.
std::vector<Differing> largest_differences(const RunComparison& compared) {
  constexpr std::size_t shown = 10;
  constexpr double rounding = 1e-9;
  std::map<std::string_view, double> size_of, size_of_unit;
  const auto metrics = metrics_table();
  for (const Metric& metric : metrics)
    for (const auto* frames : {&compared.first.frames, &compared.second.frames})
      for (const FrameMetrics& frame : *frames)
        if (const double size = std::abs(frame.*metric.value); std::isfinite(size))
          for (double* largest : {&size_of[metric.name], &size_of_unit[metric.unit]})
            *largest = std::max(*largest, size);
  std::vector<Differing> all;
  for (std::size_t i = 1; i < metrics.size(); ++i)
    if (const auto frame = largest_difference(compared, i); frame && !is_distance(metrics[i].name))
      if (const double size = size_of[metrics[i].name];
          size > rounding * size_of_unit[metrics[i].unit])
        all.push_back(
            {&metrics[i], *frame, std::abs(compared.differences[*frame].*metrics[i].value) / size});
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.part > b.part; });
  all.resize(std::min(all.size(), shown));
  return all;
}

void add_headlines(const RunComparison& compared, const std::string& out, Results& results) {
  std::string what = compared.first.name + " and " + compared.second.name + ", " +
                     std::to_string(compared.differences.size()) + " frames";
  double apart = not_measured;
  for (const FrameMetrics& frame : compared.differences)
    apart = std::fmax(apart, frame.reference_particles_max);
  if (std::isfinite(apart)) what += ", particles up to " + three_digits(apart) + " m apart";
  results.add_headline("compared", what);
  for (const auto& [metric, frame, part] : largest_differences(compared)) {
    if (part == 0) break;
    const auto of = [&, metric = metric, frame = frame](const ComparedRun& run) {
      return three_digits(run.frames[frame].*metric->value);
    };
    const std::string unit = metric->unit.empty() ? "" : " " + std::string(metric->unit);
    results.add_headline(std::string(metric->name),
                         of(compared.first) + " and " + of(compared.second) + unit + ", at " +
                             three_digits(compared.first.frames[frame].time) + " s");
  }
  results.add_headline("report", (std::filesystem::path(out) / "report.html").string());
}

/// The largest differences.
void print_comparison(const RunComparison& compared, const std::string& out, const Common& common) {
  Results results;
  results.add("frames", compared.differences.size());
  for (const std::string& remark : compared.remarks) say(common, "sinew: " + remark);
  if (!compared.remarks.empty()) results.add("remarks", compared.remarks);
  if (compared.speedup) results.add("speedup", *compared.speedup);
  add_headlines(compared, out, results);
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
  print_comparison(comparison, options.out, common);
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

/// "grip.force_z.final": words without spaces.
std::string key_of(const StudiedResult& result) {
  std::string key = result.name;
  if (const auto colon = key.find(": "); colon != std::string::npos) key.replace(colon, 2, ".");
  return key + '.' + result.kind;
}

std::string in_words(const StudiedResult& result) {
  if (!std::isfinite(result.limit.value)) return "does not converge over these radii";
  std::string words = three_digits(result.limit.value);
  words += " ± " + three_digits(result.limit.error);
  if (!result.unit.empty()) words += ' ' + result.unit;
  if (std::isfinite(result.limit.order)) words += ", order " + three_digits(result.limit.order);
  return words;
}

nlohmann::ordered_json value_of(const StudiedResult& result) {
  nlohmann::ordered_json value{{"values", result.values}};
  if (std::isfinite(result.limit.value)) {
    value["limit"] = result.limit.value;
    value["error"] = result.limit.error;
    if (std::isfinite(result.limit.order)) value["order"] = result.limit.order;
  }
  return value;
}

/// What a testing machine reads, or else the volume and the distance from the bones.
bool is_told(const StudiedResult& result, bool machine) {
  if (machine) return result.name.find(": ") != std::string::npos && result.kind == "final";
  return result.kind == "worst" &&
         (result.name == "volume_error" || result.name == "pose_error_far_rms");
}

/// The limits, or without them the final values; everything with --json.
void print_study(const Study& study, const std::string& folder, const Common& common) {
  Results results;
  results.add("runs", study.runs.size());
  results.add("frames", study.runs.front().frames.size());
  if (!study.remarks.empty()) results.add("remarks", study.remarks);
  const bool machine = !study.runs.front().machine.empty();
  for (const StudiedResult& one : study.results) {
    results.add_value(key_of(one), value_of(one));
    if (study.by_radius && is_told(one, machine) && one.measured())
      results.add_headline(key_of(one), in_words(one));
  }
  results.add_headline("report", folder + "/report.html");
  results.print(common);
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
       "sinew measure out/box_bend --write-baseline box_bend.csv",
       "sinew measure out/box_bend --baseline box_bend.csv",
       "sinew measure out/paper out/bonded -o out/paper_bonded",
       "sinew measure out/soft out/middle out/stiff -o out/stiffness",
       "sinew measure out/coarse --reference out/fine/surface.pvd",
       "sinew measure out/beam --reference beam.frd",
       "sinew measure out/box_bend --arrays 'J, strain, stress'"}};
  about.takes_scene = false;
  return run_command(
      argc, argv, about, [&](OptionList& list) { declare(list, options); },
      [&](const Common& common) {
        if (options.folders.size() > 1 && !(options.baseline + options.new_baseline).empty())
          throw bad_input("a baseline is of one run", "name one run");
        if (options.folders.size() > 2 || options.study) return study_folders(options, common);
        if (options.folders.size() == 1 && names_elements(options.reference))
          return compare_with_elements(options, common);
        return options.folders.size() == 2 ? compare_folders(options, common)
                                           : measure_folder(options, common);
      });
}
