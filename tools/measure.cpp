// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-measure: metrics.csv, metrics_bones.csv, metrics.json and report.html of a run.
#include "metrics/measure.h"
#include "command.h"
#include "core/file.h"
#include "core/stopwatch.h"
#include "law_curves.h"
#include "metrics/csv.h"
#include "metrics/json.h"
#include "metrics/report/charts.h"
#include "metrics/settling.h"
#include "metrics/table.h"
#include "report_input.h"
#include "results.h"
#include "run_files.h"
#include "run_record.h"

namespace {

using namespace sinew;

struct Options {
  std::string folder;
  std::vector<std::string> limits;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("DIR", options.folder, "Folder of the run")->required();
  app.add_option("--fail-on", options.limits,
                 "End with 1 when this holds in any frame, such as 'volume_error > 0.05'")
      ->type_name("LIMIT")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

/// Where the force between two particles depends on nothing but their distance.
std::function<double(double)> pair_force_of(const RunFiles& run) {
  const MaterialSettings& material = run.settings.material;
  if (material.model != MaterialModel::paper || material.cohesion != Cohesion::all) return {};
  return [pair = material_of(run).pair](double d) { return pair.force(d); };
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
  input.pair_force = pair_force_of(run);
  input.mass = run.body.particles.mass;
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

/// Frames that one goes to look at are in the film even where it leaves others out.
void add_worst_frames(Measured& measured, const RestBody& rest, const RunFiles& run) {
  for (const std::string_view name : telling_metrics()) {
    const auto worst = measured.summary.metrics[metric_index(name)].worst_frame;
    if (!worst || measured.film.has(*worst)) continue;
    const FrameState state = state_of(read_frame(run, *worst));
    add_frame(measured.film, *worst, rest, state, particle_values(rest, state));
  }
}

/// What the frames were like in order, beside their metrics.
struct Course {
  std::vector<std::vector<RigidFrame>> poses;
  std::vector<double> times;
  std::vector<BoneMetrics> bones;
  std::vector<std::vector<std::int64_t>> worst_particles;
};

Course measure_frames(Measured& measured, const RestBody& rest, const RunFiles& run, bool ahead) {
  Course course;
  FramesInOrder frames(run, ahead);
  for (std::size_t i = 0; i < run.frames(); ++i) {
    const FrameState state = state_of(frames.next());
    MeasuredFrame frame = measure_frame(rest, state);
    measured.frames.push_back(frame.metrics);
    for (const BoneMetrics& bone : measure_bones(rest, state)) course.bones.push_back(bone);
    if (measured.film.wants(i)) add_frame(measured.film, i, rest, state, frame.particles);
    course.worst_particles.push_back(std::move(frame.worst_particles));
    course.poses.push_back(state.bones);
    course.times.push_back(state.time);
  }
  return course;
}

Measured measure_run(const RunFiles& run, const std::vector<Limit>& limits, int threads) {
  const RestBody rest = rest_of(run);
  Measured measured;
  measured.film = plan_film(rest, run.frames());
  Course course = measure_frames(measured, rest, run, threads != 1);
  const double radius = run.body.particles.radius;
  std::vector<Hold> stills = holds(course.poses, radius);
  for (Hold& hold : stills)
    hold.settled = settling_time(hold, course.times, radius,
                                 [&](std::size_t i) { return read_frame(run, i).positions; });
  measured.summary = summarize(measured.frames, radius, std::move(stills));
  add_worst_particles(measured.summary, course.worst_particles);
  for (const Limit& limit : limits)
    measured.checks.push_back(check_limit(limit, measured.frames, measured.summary));
  measured.bones = std::move(course.bones);
  add_worst_frames(measured, rest, run);
  return measured;
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

/// Limits that were passed are told one by one.
Exit told(const std::vector<Check>& checks) {
  Exit exit = Exit::done;
  for (const Check& check : checks) {
    if (check.pass) continue;
    std::fprintf(stderr, "sinew: %s\n", describe(check).c_str());
    exit = Exit::limit_passed;
  }
  return exit;
}

Exit measure_folder(const Options& options, const Common& common) {
  std::vector<Limit> limits;
  for (const std::string& text : options.limits) limits.push_back(parse_limit(text));
  Stopwatch watch;
  const RunFiles run = open_run({options.folder});
  Measured measured = measure_run(run, limits, common.threads);
  write_file(run.folder.path / "metrics.csv", metrics_csv(measured.frames));
  write_file(run.folder.path / "metrics_bones.csv", bone_metrics_csv(measured.bones));
  write_file(run.folder.path / "metrics.json",
             metrics_json(measured.frames, measured.summary, measured.checks));
  record_stage(run.folder, "measuring", watch.lap());
  print_results(measured, common.json);
  const Exit exit = told(measured.checks);
  write_file(run.folder.path / "report.html", report_html(report_input(run, std::move(measured))));
  return exit;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  About about{
      "measure",
      "Measures a run: metrics.csv, metrics_bones.csv, metrics.json, report.html.",
      {"sinew measure out/box_bend", "sinew measure out/box_bend --fail-on 'volume_error > 0.05'"}};
  about.takes_scene = false;
  return run_command(
      argc, argv, about, [&](CLI::App& app) { declare(app, options); },
      [&](const Common& common) { return measure_folder(options, common); });
}
