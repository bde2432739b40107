// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-measure: metrics.csv, metrics.json and report.html of a run.
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "command.h"
#include "core/file.h"
#include "core/number_text.h"
#include "core/stopwatch.h"
#include "metrics/csv.h"
#include "metrics/json.h"
#include "metrics/measure.h"
#include "metrics/report.h"
#include "metrics/settling.h"
#include "metrics/table.h"
#include "results.h"
#include "run_files.h"
#include "run_record.h"

namespace {

using namespace sinew;

struct Options {
  std::string folder;
  std::vector<std::string> limits;
};

struct Measured {
  std::vector<FrameMetrics> frames;
  Summary summary;
  std::vector<Check> checks;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("DIR", options.folder, "Folder of the run")->required();
  app.add_option("--fail-on", options.limits,
                 "End with 1 when this holds in any frame, such as 'volume_error > 0.05'")
      ->type_name("LIMIT")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

RestBody rest_of(const RunFiles& run) {
  RestInput input;
  input.positions = positions_of(run.body.particles);
  input.surface = run.surface;
  input.bone.assign(run.body.bone->begin(), run.body.bone->end());
  for (const Bone& bone : run.skeleton.bones)
    input.bones.push_back({bone.name, bone.parent, bone.length, bone.rest});
  input.radius = run.body.particles.radius;
  input.interaction_range = run.settings.material.b * input.radius;
  input.start = read_frame(run, 0).energies;
  return rest_body(std::move(input));
}

FrameState state_of(RunFrame frame) {
  return {frame.time,
          std::move(frame.positions),
          std::move(frame.velocities),
          std::move(frame.surface_points),
          std::move(frame.bones),
          frame.energies};
}

Measured measure_run(const RunFiles& run, const std::vector<Limit>& limits) {
  const RestBody rest = rest_of(run);
  Measured measured;
  std::vector<std::vector<RigidFrame>> poses;
  std::vector<double> times;
  for (std::size_t i = 0; i < run.frames(); ++i) {
    const FrameState state = state_of(read_frame(run, i));
    measured.frames.push_back(measure(rest, state));
    poses.push_back(state.bones);
    times.push_back(state.time);
  }
  const double radius = run.body.particles.radius;
  std::vector<Hold> stills = holds(poses, radius);
  for (Hold& hold : stills)
    hold.settled = settling_time(hold, times, radius,
                                 [&](std::size_t i) { return read_frame(run, i).positions; });
  measured.summary = summarize(measured.frames, radius, std::move(stills));
  for (const Limit& limit : limits)
    measured.checks.push_back(check_limit(limit, measured.frames, measured.summary));
  return measured;
}

std::string with_unit(double value, const char* unit) {
  return three_digits(value) + (*unit ? std::string(" ") + unit : "");
}

std::vector<FactGroup> facts_of(const RunFolder& folder) {
  const auto record = read_record(folder);
  const auto number = [&](const char* key, const char* unit) {
    return with_unit(record.value(key, 0.0), unit);
  };
  const auto material = record.value("material", nlohmann::ordered_json::object());
  const auto constant = [&](const char* key, const char* unit) {
    return with_unit(material.value(key, 0.0), unit);
  };
  return {{"Run",
           {{"status", record.value("status", "")},
            {"particles", std::to_string(record.value("particles", 0))},
            {"frames", std::to_string(record.value("frames", 0))},
            {"steps", std::to_string(record.value("steps", std::int64_t{0}))},
            {"time step", number("time_step", "s")},
            {"share of the stability limit", number("time_step_factor", "")},
            {"particle-steps per second", number("particle_steps_per_second", "")},
            {"state hash", record.value("state_hash", "")},
            {"started", record.value("started", "")}}},
          {"Material",
           {{"Young's modulus", constant("young_modulus", "Pa")},
            {"k1", constant("k1", "Pa")},
            {"k2", constant("k2", "Pa")},
            {"a", constant("a", "m")},
            {"b", constant("b", "m")},
            {"lambda", constant("lambda", "")},
            {"damping constant C", constant("damping", "kg/s")},
            {"particle radius", number("radius", "m")},
            {"particle mass", number("particle_mass", "kg")}}}};
}

/// "0.533 s" for the picture of frame 16, else the file's own name.
std::string caption_of(const std::filesystem::path& picture, const Measured& measured) {
  const std::string name = picture.stem().string();
  const auto digits = name.find_first_of("0123456789");
  if (digits == std::string::npos) return "Over time";
  const auto frame = std::strtoul(name.c_str() + digits, nullptr, 10);
  return frame < measured.frames.size() ? three_digits(measured.frames[frame].time) + " s" : name;
}

/// The pictures that render has left: the contact sheet, then single moments in order.
std::vector<Picture> pictures_in(const RunFolder& folder, const Measured& measured) {
  std::vector<Picture> pictures;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder.pictures(), none))
    if (entry.path().extension() == ".png")
      pictures.push_back(
          {"pictures/" + entry.path().filename().string(), caption_of(entry.path(), measured)});
  const auto is_sheet = [](const Picture& picture) {
    return picture.path.find("contact_sheet") != std::string::npos;
  };
  std::sort(pictures.begin(), pictures.end(), [&](const Picture& a, const Picture& b) {
    return is_sheet(a) != is_sheet(b) ? is_sheet(a) : a.path < b.path;
  });
  return pictures;
}

std::string title_of(const RunFolder& folder) {
  return std::filesystem::absolute(folder.path / ".").lexically_normal().parent_path().filename();
}

void write_report(const RunFiles& run, const Measured& measured) {
  ReportInput input;
  input.title = title_of(run.folder);
  input.version = version();
  input.radius = run.body.particles.radius;
  try {
    input.facts = facts_of(run.folder);
  } catch (const nlohmann::json::exception&) {
    throw bad_input(Place{run.folder.record().string()}, "is not the record of a run",
                    "run the scene again with --force");
  }
  input.frames = measured.frames;
  input.summary = measured.summary;
  input.checks = measured.checks;
  input.pictures = pictures_in(run.folder, measured);
  if (std::filesystem::exists(run.folder.pictures() / "movie.mp4"))
    input.movie = "pictures/movie.mp4";
  input.scene_text = run.scene_text;
  write_file(run.folder.path / "report.html", report_html(input));
}

double worst_of(const Measured& measured, const Metric& metric, const MetricSummary& summary) {
  return summary.worst_frame ? measured.frames[*summary.worst_frame].*metric.value : not_measured;
}

void print_results(const Measured& measured, bool as_json) {
  Results results;
  results.add("frames", measured.frames.size());
  const auto metrics = metrics_table();
  for (std::size_t i = 1; i < metrics.size(); ++i) {
    const double worst = worst_of(measured, metrics[i], measured.summary.metrics[i]);
    results.add("worst_" + std::string(metrics[i].name), worst, std::string(metrics[i].unit));
  }
  for (const RunMetric& metric : run_metrics_table())
    results.add(std::string(metric.name), measured.summary.*metric.value, std::string(metric.unit));
  results.print(as_json);
}

Exit measure_folder(const Options& options, const Common& common) {
  std::vector<Limit> limits;
  for (const std::string& text : options.limits) limits.push_back(parse_limit(text));
  Stopwatch watch;
  const RunFiles run = open_run({options.folder});
  const Measured measured = measure_run(run, limits);
  write_file(run.folder.path / "metrics.csv", metrics_csv(measured.frames));
  write_file(run.folder.path / "metrics.json",
             metrics_json(measured.frames, measured.summary, measured.checks));
  record_stage(run.folder, "measuring", watch.lap());
  write_report(run, measured);
  print_results(measured, common.json);
  Exit exit = Exit::done;
  for (const Check& check : measured.checks) {
    if (check.pass) continue;
    std::fprintf(stderr, "sinew: %s\n", describe(check).c_str());
    exit = Exit::limit_passed;
  }
  return exit;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  About about{
      "measure",
      "Measures a run: metrics.csv, metrics.json, report.html.",
      {"sinew measure out/box_bend", "sinew measure out/box_bend --fail-on 'volume_error > 0.05'"}};
  about.takes_scene = false;
  return run_command(
      argc, argv, about, [&](CLI::App& app) { declare(app, options); },
      [&](const Common& common) { return measure_folder(options, common); });
}
