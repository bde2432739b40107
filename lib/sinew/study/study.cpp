// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/study.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include <sinew/metrics/table.h>
#include <sinew/run/machine_columns.h>
#include <sinew/run/run_record.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

/// A run with what is needed only while the study is made.
struct Opened {
  RunFiles files;
  Measured measured;
  std::vector<MachineColumn> machine;  ///< at its own times
};

double seconds_of(const RunFolder& folder) {
  const nlohmann::ordered_json record = read_record(folder);
  const auto seconds = record.find("seconds");
  if (seconds == record.end() || !seconds->is_object()) return not_measured;
  const auto stepping = seconds->find("stepping");
  return stepping != seconds->end() && stepping->is_number() ? stepping->get<double>()
                                                             : not_measured;
}

void refuse_doubles(const std::vector<fs::path>& folders) {
  std::set<fs::path> seen;
  for (const fs::path& folder : folders)
    if (!seen.insert(fs::weakly_canonical(folder)).second)
      throw bad_input(Place{folder.string()}, "is named twice", "name each run once");
}

/// Frames of the first run whose times all of the others have.
std::vector<double> common_times(const std::vector<Opened>& runs) {
  std::vector<double> times;
  for (const FrameMetrics& frame : runs.front().measured.frames) {
    const auto has = [&](const Opened& run) {
      const auto at = frame_at(run.files.particle_rows, frame.time);
      return at && *at < run.measured.frames.size();
    };
    if (std::all_of(runs.begin(), runs.end(), has)) times.push_back(frame.time);
  }
  if (times.empty())
    throw bad_input("the runs have no frame at the same time",
                    "run them with the same output.interval");
  return times;
}

std::vector<MachineColumn> machine_at(const std::vector<MachineColumn>& columns,
                                      const std::vector<double>& times) {
  constexpr double same_time = 1e-6;  // s
  std::vector<MachineColumn> all;
  if (columns.empty()) return all;
  const std::vector<double>& own = columns.front().values;
  for (std::size_t c = 1; c < columns.size(); ++c) {
    all.push_back({columns[c].name, columns[c].unit, {}});
    for (const double time : times) {
      const auto at = std::lower_bound(own.begin(), own.end(), time - same_time);
      const bool found = at != own.end() && *at < time + same_time;
      all.back().values.push_back(
          found ? columns[c].values[static_cast<std::size_t>(at - own.begin())] : not_measured);
    }
  }
  return all;
}

StudiedRun studied(const Opened& run, const std::vector<double>& times) {
  StudiedRun out;
  out.name = name_of_run(run.files.folder.path);
  out.radius = run.files.body.particles.radius;
  out.particles = run.files.body.particles.size();
  out.seconds = seconds_of(run.files.folder);
  for (const double time : times)
    out.frames.push_back(run.measured.frames[*frame_at(run.files.particle_rows, time)]);
  out.machine = machine_at(run.machine, times);
  return out;
}

/// Folders of the same name get their paths.
void tell_apart(std::vector<StudiedRun>& runs, const std::vector<fs::path>& folders) {
  std::map<std::string, int> count;
  for (const StudiedRun& run : runs) ++count[run.name];
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (count[runs[i].name] > 1) runs[i].name = folders[i].lexically_normal().string();
}

using Values = std::vector<double>;

bool is_reported(const Values& values) {
  return std::any_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

double last_of(const Values& values) { return values.empty() ? not_measured : values.back(); }

double worst_of(const Opened& run, std::size_t metric) {
  const MetricSummary& summary = run.measured.summary.metrics[metric];
  if (!summary.worst_frame) return not_measured;
  return run.measured.frames[*summary.worst_frame].*metrics_table()[metric].value;
}

class ResultsOf {
 public:
  ResultsOf(const std::vector<Opened>& opened, const std::vector<StudiedRun>& runs)
      : opened_(opened), runs_(runs) {}

  std::vector<StudiedResult> all() {
    for (std::size_t i = 1; i < metrics_table().size(); ++i) add_metric(i);
    for (const RunMetric& metric : run_metrics_table())
      add(metric.name, "run", metric.unit,
          [&](std::size_t run) { return opened_[run].measured.summary.*metric.value; });
    for (const MachineColumn& column : runs_.front().machine) add_column(column);
    return std::move(results_);
  }

 private:
  template <class Of>
  void add(std::string_view name, const char* kind, std::string_view unit, const Of& of) {
    StudiedResult result{std::string(name), kind, std::string(unit), {}, {}};
    for (std::size_t run = 0; run < runs_.size(); ++run) result.values.push_back(of(run));
    if (is_reported(result.values)) results_.push_back(std::move(result));
  }

  void add_metric(std::size_t number) {
    const Metric& metric = metrics_table()[number];
    add(metric.name, "final", metric.unit,
        [&](std::size_t run) { return runs_[run].frames.back().*metric.value; });
    add(metric.name, "worst", metric.unit,
        [&](std::size_t run) { return worst_of(opened_[run], number); });
  }

  void add_column(const MachineColumn& column) {
    const auto of = [&](std::size_t run) -> const Values& {
      static const Values none;
      for (const MachineColumn& one : runs_[run].machine)
        if (one.name == column.name) return one.values;
      return none;
    };
    add(column.name, "final", column.unit, [&](std::size_t run) { return last_of(of(run)); });
    std::vector<Values> all;
    for (std::size_t run = 0; run < runs_.size(); ++run) all.push_back(of(run));
    const Values largest = largest_of_one_sign(all);
    add(column.name, "largest", column.unit, [&](std::size_t run) { return largest[run]; });
  }

  const std::vector<Opened>& opened_;
  const std::vector<StudiedRun>& runs_;
  std::vector<StudiedResult> results_;
};

/// Whether nothing but the radius (or the number of particles it follows from) differs.
bool differ_by_radius(const Study& study) {
  std::set<double> radii;
  for (const StudiedRun& run : study.runs) radii.insert(run.radius);
  const auto is_size = [](const DifferingSetting& one) {
    return one.section == "body" && (one.name == "radius" || one.name == "count");
  };
  return radii.size() == study.runs.size() && !study.settings.empty() &&
         std::all_of(study.settings.begin(), study.settings.end(), is_size);
}

void add_limits(Study& study) {
  std::vector<double> radii;
  for (const StudiedRun& run : study.runs) radii.push_back(run.radius);
  for (StudiedResult& result : study.results)
    result.limit = within(continuum_limit(radii, result.values), range_of(result.name));
}

std::vector<std::string> remarks_on(const std::vector<Opened>& runs, std::size_t common) {
  std::vector<std::string> remarks;
  std::size_t lone = 0;
  for (const Opened& run : runs) {
    lone += run.measured.frames.size() - common;
    if (const std::string status = status_of(run.files.folder); status != "finished")
      remarks.push_back("The run " + run.files.folder.path.string() + " is not finished: it is " +
                        (status.empty() ? "of unknown status" : status) + '.');
  }
  if (lone > 0)
    remarks.push_back(std::to_string(lone) +
                      " frames have no counterpart at their time in all of the runs.");
  return remarks;
}

}  // namespace

bool StudiedResult::measured() const {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

Study study_runs(const std::vector<fs::path>& folders, const MeasureOptions& how) {
  refuse_doubles(folders);
  std::vector<Opened> opened;
  for (const fs::path& folder : folders) {
    Opened run{open_run({folder}), {}, machine_columns(folder)};
    run.measured = measure_run(run.files, {{}, how.reference, {}, how.ahead, false});
    opened.push_back(std::move(run));
    if (how.progress) how.progress(opened.size(), folders.size());
  }
  const std::vector<double> times = common_times(opened);
  Study study;
  std::vector<const Settings*> scenes;
  for (const Opened& run : opened) {
    study.runs.push_back(studied(run, times));
    scenes.push_back(&run.files.settings);
  }
  tell_apart(study.runs, folders);
  study.settings = differing_settings(scenes);
  study.results = ResultsOf(opened, study.runs).all();
  study.by_radius = differ_by_radius(study);
  if (study.by_radius) add_limits(study);
  study.remarks = remarks_on(opened, times.size());
  return study;
}

}  // namespace sinew
