// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-sweep: runs a scene with many values of its settings, and puts the results into tables and
// on a page.
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <vector>

#include <sinew/core/file.h>
#include <sinew/core/json.h>
#include <sinew/core/text.h>
#include <sinew/settings/text_file.h>
#include <sinew/study/compare_runs.h>
#include <sinew/study/sweep/sweep_table.h>
#include "command/child.h"
#include "command/command.h"
#include "command/drawing.h"
#include "command/progress.h"
#include "command/results.h"
#include "command/sweep_runner.h"

namespace {

using namespace sinew;
namespace fs = std::filesystem;

struct Options {
  std::string study, folder, shard;
  std::vector<std::string> merged;
  int jobs = 0;
  double memory = 0;   ///< GB
  double timeout = 0;  ///< s
  bool dry_run = false, retry_failed = false, strict = false, force = false, table = false;
};

constexpr const char* record_name = "sweep.json";

/// The study itself, or that of a folder in which one was run.
fs::path study_of(const Options& options) {
  if (!fs::is_directory(options.study)) return options.study;
  const fs::path record = fs::path(options.study) / record_name;
  constexpr std::uint64_t largest = 1 << 20;
  if (fs::exists(record)) {
    const auto found = parsed_json<nlohmann::ordered_json>(read_file(record, largest));
    if (found.is_object() && found.contains("study") && found["study"].is_string())
      return fs::path(options.study) / found["study"].get<std::string>();
  }
  throw bad_input(Place{options.study}, "is not the folder of a sweep",
                  "name the study: sinew sweep STUDY.yaml");
}

fs::path folder_of(const Options& options, const fs::path& study) {
  if (!options.folder.empty()) return fs::absolute(options.folder);
  if (fs::is_directory(options.study)) return fs::absolute(options.study);
  return fs::absolute(fs::path("out") / study.stem());
}

/// Throws bad input for a folder of something else, whose files would be replaced. The folder of
/// the study itself is none, unless such files lie there.
void refuse_other_folder(const Sweep& sweep) {
  const fs::path& folder = sweep.folder;
  refuse_folders_of_runs(folder, {});
  std::error_code none;
  if (fs::exists(folder / record_name, none) || !fs::exists(folder, none)) return;
  if (fs::is_directory(folder, none) && fs::is_empty(folder, none)) return;
  const auto replaced = {"runs",        "index.csv", "results.csv",
                         "report.html", "sweep.log", "sweep.pvd"};
  if (fs::equivalent(sweep.file.path.parent_path(), folder, none) &&
      std::none_of(replaced.begin(), replaced.end(),
                   [&](const char* name) { return fs::exists(folder / name, none); }))
    return;
  throw bad_input(Place{folder.string()}, "holds other files than those of a sweep",
                  "choose another folder with -o");
}

/// "3/8": the third of eight.
struct Shard {
  std::size_t number = 1, of = 1;
};

Shard shard_of(const std::string& text) {
  if (text.empty()) return {};
  Shard shard;
  char rest = 0;
  const int read = std::sscanf(text.c_str(), "%zu/%zu%c", &shard.number, &shard.of, &rest);
  if (read != 2 || shard.number < 1 || shard.number > shard.of)
    throw bad_input("--shard " + shown(text) + " is no part of a sweep",
                    "write --shard 3/8 for the third of eight");
  return shard;
}

void keep_shard(Sweep& sweep, const Shard& shard) {
  std::vector<SweepRun> mine;
  for (std::size_t k = shard.number - 1; k < sweep.runs.size(); k += shard.of)
    mine.push_back(std::move(sweep.runs[k]));
  sweep.runs = std::move(mine);
}

/// Whether the run is to be done now. Throws bad input for what changed below a finished one.
bool is_wanted(const Sweep& sweep, const SweepRun& run, const Options& options) {
  const RunState state = state_of(sweep, run);
  if (state.status == RunStatus::failed) return options.retry_failed || options.force;
  if (state.status == RunStatus::missing) return true;
  if (options.force) return state.files != run.files || state.program != version();
  refuse_changed(sweep, run, state);
  return false;
}

std::vector<std::size_t> wanted(const Sweep& sweep, const Options& options) {
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < sweep.runs.size(); ++k)
    if (is_wanted(sweep, sweep.runs[k], options)) numbers.push_back(k);
  return numbers;
}

/// The table of what would run, for people and as JSON.
Exit tell_plan(const Sweep& sweep, const std::vector<std::size_t>& numbers,
               const std::vector<Foreseen>& foreseen, const RunnerOptions& how,
               const Common& common) {
  auto rows = nlohmann::ordered_json::array();
  std::string lines;
  for (const std::size_t k : numbers) {
    const Foreseen& one = foreseen[k];
    nlohmann::ordered_json values;
    for (std::size_t q = 0; q < sweep.file.vary.size(); ++q)
      values[sweep.file.vary[q].path] = sweep.runs[k].values[q];
    rows.push_back({{"folder", "runs/" + sweep.runs[k].name},
                    {"values", std::move(values)},
                    {"particles", one.particles},
                    {"steps", one.steps},
                    {"seconds", one.seconds},
                    {"memory", one.memory},
                    {"disk", one.disk}});
    lines += fmt::format("{}  {} particles, {} steps, {}, {} of memory, {} of disk\n",
                         sweep.runs[k].name, one.particles, one.steps, duration_text(one.seconds),
                         bytes_text(static_cast<double>(one.memory)),
                         bytes_text(static_cast<double>(one.disk)));
  }
  const nlohmann::ordered_json all{{"runs", std::move(rows)}, {"all", sweep.runs.size()},
                                   {"seconds", how.seconds},  {"jobs", how.jobs},
                                   {"threads", how.threads},  {"memory", how.needed},
                                   {"disk", how.disk}};
  print_out((common.json ? json_text(all, 2) : lines + plan_text(sweep, numbers.size(), how)) +
            '\n');
  return Exit::done;
}

/// Draws a small picture of each run that has frames.
void draw(const Sweep& sweep, const SweepTable& table) {
  std::string list;
  for (std::size_t k = 0; k < table.size(); ++k) {
    const fs::path folder = sweep.folder_of(sweep.runs[k]).path;
    if (table[k].state.status == RunStatus::finished && has_frames({folder}))
      list += folder.string() + '\n';
  }
  if (list.empty() || !draws) return;
  const fs::path file = sweep.folder / ".pictures";
  write_file(file, list);
  run_child("render", {"--quiet", "--small", file.string()});
  fs::remove(file);
}

SweepTable write_results(const Sweep& sweep) {
  SweepTable table = read_table(sweep);
  draw(sweep, table);
  for (std::size_t k = 0; k < table.size(); ++k)
    if (table[k].state.status == RunStatus::finished)
      remove_frames(sweep.folder_of(sweep.runs[k]), sweep.file.keep);
  write_moments(sweep, table);
  write_tables(sweep, table);
  write_file(sweep.folder / "report.html",
             sweep_html(sweep, table, sweep.file.path.stem().string()));
  return table;
}

/// Takes the folder's place at once: a copy that is ended leaves no part of a run.
void put_copy(const fs::path& from, const fs::path& to, const fs::path& aside) {
  fs::remove_all(aside);
  create_folder(to.parent_path());
  fs::copy(from, aside, fs::copy_options::recursive);
  fs::remove_all(to);
  fs::rename(aside, to);
}

/// Copies what other machines did into this folder. Of a run that several did, the finished one
/// that was the fastest is taken: the order of the folders does not matter.
void merge(const Sweep& sweep, const std::vector<fs::path>& folders) {
  const auto rank = [](const RunState& state) {
    return std::tuple(state.status == RunStatus::missing, state.status == RunStatus::failed,
                      state.seconds, state.reason);
  };
  for (const SweepRun& run : sweep.runs) {
    RunState best = state_of(sweep, run);
    fs::path from;
    for (const fs::path& folder : folders) {
      const Sweep other{sweep.file, folder};
      const RunState state = state_of(other, run);
      if (!(rank(state) < rank(best)) || fs::equivalent(folder, sweep.folder)) continue;
      refuse_changed(other, run, state);
      best = state, from = other.folder_of(run).path;
    }
    if (!from.empty()) put_copy(from, sweep.folder_of(run).path, sweep.folder / ".copying");
  }
}

void record_study(const Sweep& sweep) {
  const nlohmann::ordered_json record{{"schema_version", 1},
                                      {"study", seen_from(sweep.folder, sweep.file.path).string()}};
  write_file(sweep.folder / record_name, json_text(record, 2) + '\n');
}

/// Tells how it ended.
Exit tell_end(const Sweep& sweep, const SweepTable& table, const Options& options,
              const Common& common) {
  const auto count = [&](RunStatus status) {
    return static_cast<std::size_t>(
        std::count_if(table.begin(), table.end(),
                      [&](const SweepRow& row) { return row.state.status == status; }));
  };
  const std::size_t failed = count(RunStatus::failed);
  Results results;
  results.add("runs", table.size());
  results.add("finished", count(RunStatus::finished));
  results.add("failed", failed);
  results.add("missing", count(RunStatus::missing));
  results.add("index", (sweep.folder / "index.csv").string());
  results.add("report", (sweep.folder / "report.html").string());
  results.add("results", (sweep.folder / "results.csv").string());
  results.print(common);
  if (failed > 0)
    print_error("sinew: warning: " + std::to_string(failed) + " of " +
                std::to_string(table.size()) +
                " runs failed: see index.csv; do them again with --retry-failed");
  if (sweep.file.keep == KeptFrames::metrics)
    say(common, "sinew: no sweep.pvd, since the study keeps metrics alone");
  for (const std::string& name : strangers_of(sweep))
    say(common,
        "sinew: warning: runs/" + name + " is not in the study, and left out of the tables");
  return failed > 0 && (options.strict || failed == table.size()) ? Exit::unstable : Exit::done;
}

Exit run_missing(Sweep& sweep, const Options& options, const Common& common) {
  std::vector<std::size_t> numbers = wanted(sweep, options);
  std::vector<Foreseen> foreseen(sweep.runs.size()), needed;
  Forecast forecast;
  for (const std::size_t k : numbers)
    needed.push_back(foreseen[k] = forecast.of(settings_of(sweep, sweep.runs[k])));
  constexpr double giga = 1e9;
  RunnerOptions how = packed(sweep, needed, common, options.jobs, options.memory * giga);
  how.timeout = options.timeout;
  if (options.dry_run) return tell_plan(sweep, numbers, foreseen, how, common);
  say(common, numbers.empty() ? "sinew: all runs are done" : plan_text(sweep, numbers.size(), how));
  refuse_other_folder(sweep);
  const FolderLock lock({sweep.folder}, create({sweep.folder}));
  record_study(sweep);
  const Exit exit = run_all(sweep, numbers, foreseen, how, common);
  const SweepTable table = write_results(sweep);
  if (exit == Exit::interrupted) say(common, "sinew: stopped; give the same command to go on");
  return exit == Exit::done ? tell_end(sweep, table, options, common) : exit;
}

Exit run(const Options& options, const Common& common) {
  const fs::path study = study_of(options), folder = folder_of(options, study);
  std::vector<fs::path> merged;
  for (const std::string& one : options.merged) {
    if (!fs::is_directory(one))
      throw bad_input(Place{one}, "is no folder", "name the folders of shards after --merge");
    merged.push_back(fs::absolute(one));
  }
  SweepFile file = read_sweep(study);
  file.path = fs::absolute(study);
  fs::current_path(file.path.parent_path());  // paths in the study are from there
  Sweep sweep = plan_sweep(std::move(file), folder);
  keep_shard(sweep, shard_of(options.shard));
  if (!options.table && merged.empty()) return run_missing(sweep, options, common);
  refuse_other_folder(sweep);
  const FolderLock lock({folder}, create({folder}));
  merge(sweep, merged);
  record_study(sweep);
  return tell_end(sweep, write_results(sweep), options, common);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  About about{"sweep",
              "Runs a scene with many values of its settings: index.csv, results.csv, report.html.",
              {"sinew sweep stiffness.yaml --dry-run", "sinew sweep stiffness.yaml --jobs 4",
               "sinew sweep stiffness.yaml --shard 3/8 -o part3",
               "sinew sweep stiffness.yaml --merge part1 part2 -o all",
               "sinew sweep out/stiffness --table"}};
  about.takes_scene = false;
  return run_command(
      argc, argv, about,
      [&](OptionList& list) {
        list.add("STUDY", options.study, "Study (YAML), or the folder of a sweep").required();
        list.add("-o", options.folder, "Folder of the sweep; by default out/NAME-OF-STUDY")
            .type_name("DIR");
        list.add_flag("--dry-run", options.dry_run, "Tell what would run, and end");
        list.add("--jobs", options.jobs,
                 "Runs at a time; by default as many as cores and memory allow")
            .range(1, 1024);
        list.add("--memory", options.memory, "Memory that the runs may take together, GB")
            .positive();
        list.add("--timeout", options.timeout, "Longest time of a run, s").positive();
        list.add_flag("--retry-failed", options.retry_failed, "Do failed runs again");
        list.add_flag("--strict", options.strict, "End with code 3 where any run failed");
        list.add_flag("--force", options.force,
                      "Do runs again whose mesh, rig, clip or program has changed");
        list.add("--shard", options.shard, "Every N-th run alone, from the K-th on")
            .type_name("K/N");
        list.add("--merge", options.merged, "Folders of shards, to be put together")
            .type_name("DIR...");
        list.add_flag("--table", options.table, "Write the tables anew, and run nothing");
      },
      [&](const Common& common) { return run(options, common); });
}
