// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/compare_runs.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include <sinew/core/file.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/mesh/surface_gap.h>
#include <sinew/metrics/files.h>
#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/report/comparison_page.h>
#include <sinew/metrics/table.h>
#include <sinew/run/run_files.h>
#include <sinew/run/run_record.h>
#include <sinew/run/world_shown.h>
#include <sinew/settings/row.h>
#include <sinew/settings/table.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

constexpr double same_place = 1e-6;        // radii: two bodies have the same rest positions
constexpr double same_float_place = 1e-3;  // radii: likewise, of surfaces read from Float32

/// One of the two runs, with the data needed before reading the other.
struct Side {
  explicit Side(const fs::path& folder) : run(open_run({folder})), rest(rest_of(run)) {}

  RunFiles run;
  RestBody rest;
  Measured measured;
  Playback playback;
};

using Pair = std::array<std::size_t, 2>;

/// Frames of the same times, ascending.
std::vector<Pair> matched_frames(const RunFiles& first, const RunFiles& second) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < first.frames(); ++i)
    if (const auto j = frame_at(second.particle_rows, first.particle_rows[i].time))
      if (*j < second.frames()) pairs.push_back({i, *j});
  if (pairs.empty())
    throw bad_input("the runs have no frame at the same time",
                    "run both with the same output.interval");
  return pairs;
}

bool began_alike(const Points& one, const Points& other, double tolerance) {
  if (one.size() != other.size()) return false;
  for (std::size_t i = 0; i < one.size(); ++i)
    if ((one[i] - other[i]).norm() > tolerance) return false;
  return true;
}

/// The points that both runs have in common, so that distances between them are meaningful.
struct Alike {
  bool particles = false, surface = false;
};

Alike alike(const Side& first, const Side& second) {
  const double r = first.rest.radius();
  return {
      began_alike(first.rest.shape.points, second.rest.shape.points, same_place * r),
      first.run.surface.faces == second.run.surface.faces &&
          began_alike(first.run.surface.points, second.run.surface.points, same_float_place * r)};
}

std::string counted(const Points& one, const Points& other, const char* what) {
  std::string text = std::to_string(one.size());
  text += " and ";
  text += std::to_string(other.size());
  return text + ' ' + what;
}

std::vector<std::string> remarks_on(const Side& first, const Side& second, const Alike& same,
                                    std::size_t pairs) {
  std::vector<std::string> remarks;
  if (!same.particles)
    remarks.push_back("The particles are not the same (" +
                      counted(first.rest.shape.points, second.rest.shape.points, "of them") +
                      ", or at other positions at rest): no distance between them is computed.");
  if (!same.surface)
    remarks.push_back("The surfaces are not the same mesh (" +
                      counted(first.run.surface.points, second.run.surface.points, "points") +
                      "): only nearest points are compared.");
  const std::size_t lone = first.run.frames() + second.run.frames() - 2 * pairs;
  if (lone > 0)
    remarks.push_back(std::to_string(lone) +
                      " frames have no counterpart at their time in the other run.");
  return remarks;
}

Statistics apart(const Points& one, const Points& other) {
  return statistics(one.size(), [&](std::size_t i) { return (one[i] - other[i]).norm(); });
}

void add_distances(FrameMetrics& out, const FrameState& one, const FrameState& other,
                   const Side& first, const Side& second, const Alike& same) {
  if (same.particles) {
    const Statistics particles = apart(one.positions, other.positions);
    out.reference_particles_rms = particles.rms();
    out.reference_particles_max = particles.max();
  }
  if (same.surface) {
    const Statistics points = apart(one.surface_points, other.surface_points);
    out.reference_surface_rms = points.rms();
    out.reference_surface_max = points.max();
  }
  const SurfaceGap gap = surface_gap({one.surface_points, first.run.surface.faces},
                                     {other.surface_points, second.run.surface.faces});
  out.reference_hausdorff = gap.hausdorff;
  out.reference_distance_mean = gap.mean;
}

void add_snapshot(Side& side, std::size_t number, const FrameState& state) {
  if (side.playback.wants(number))
    add_frame(side.playback, number, side.rest, state, particle_values(side.rest, state));
}

/// What needs both runs at once: distances, added to the second one's metrics, and the playbacks.
void hold_together(Side& first, Side& second, const std::vector<Pair>& pairs, const Alike& same) {
  for (Side* side : {&first, &second}) {
    side->playback = plan_playback(side->rest, pairs.size(), 0.5);
    side->playback.ranges = side->measured.ranges;
  }
  second.playback.wanted = first.playback.wanted;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const FrameState one = read_frame(first.run, pairs[k][0]);
    const FrameState other = read_frame(second.run, pairs[k][1]);
    add_distances(second.measured.frames[pairs[k][1]], one, other, first, second, same);
    add_snapshot(first, k, one);
    add_snapshot(second, k, other);
  }
  show_world(first.playback, first.run, [&](std::size_t pair) { return pairs[pair][0]; });
  show_world(second.playback, second.run, [&](std::size_t pair) { return pairs[pair][1]; });
}

/// Where both runs say how long their steps took.
std::optional<double> speedup_of(const Side& first, const Side& second) {
  for (const Side* side : {&first, &second})
    if (!fs::exists(side->run.folder.record())) return {};
  const double one = seconds_of(first.run.folder, "stepping");
  const double other = seconds_of(second.run.folder, "stepping");
  return one > 0 && other > 0 ? std::optional(one / other) : std::nullopt;
}

ComparedRun compared_run(const Side& side, const std::vector<Pair>& pairs, std::size_t which) {
  ComparedRun run{name_of_run(side.run.folder.path),
                  {},
                  side.measured.summary,
                  side.rest.radius(),
                  side.rest.particles()};
  for (const Pair& pair : pairs) run.frames.push_back(side.measured.frames[pair[which]]);
  return run;
}

void write_comparison(const RunComparison& compared, const Side& first, const Side& second,
                      const fs::path& out) {
  create_folder(out);
  write_file(out / "compare.csv", comparison_csv(compared));
  write_file(out / "metrics.json", comparison_json(compared));
  const Playback playback = side_by_side(first.playback, second.playback, {"a: ", "b: "});
  write_file(
      out / "report.html",
      comparison_html({version(), compared, playback,
                       facts_of(differing_settings({&first.run.settings, &second.run.settings})),
                       first.run.scene_text, second.run.scene_text}));
}

}  // namespace

std::vector<DifferingSetting> differing_settings(const std::vector<const Settings*>& scenes) {
  std::vector<DifferingSetting> all;
  for (const auto& row : settings_table()) {
    DifferingSetting one{row.section, row.name, {}};
    for (const Settings* scene : scenes)
      one.values.push_back(scene_text(row.get(*scene), row.absent));
    const auto differs =
        std::adjacent_find(one.values.begin(), one.values.end(), std::not_equal_to<>());
    if (differs != one.values.end()) all.push_back(std::move(one));
  }
  return all;
}

std::vector<FactGroup> facts_of(const std::vector<DifferingSetting>& settings) {
  std::vector<FactGroup> groups;
  for (const DifferingSetting& one : settings) {
    if (groups.empty() || groups.back().title != one.section)
      groups.push_back({std::string(one.section), {}});
    std::string change;
    for (const std::string& value : one.values) (change += change.empty() ? "" : " → ") += value;
    groups.back().facts.push_back({std::string(one.name), std::move(change)});
  }
  return groups;
}

std::string name_of_run(const fs::path& folder) {
  return fs::absolute(folder / ".").lexically_normal().parent_path().filename();
}

void refuse_folders_of_runs(const fs::path& out, const std::vector<fs::path>& runs) {
  std::error_code none;
  for (const fs::path& run : runs)
    if (fs::equivalent(out, run, none))
      throw bad_input(Place{out.string()}, "is one of the runs: their reports would be lost",
                      "name another folder with -o");
  if (fs::exists(out / "run.json", none))
    throw bad_input(Place{out.string()}, "holds a run: its reports would be lost",
                    "name another folder with -o");
}

RunComparison compare_runs(const fs::path& first_folder, const fs::path& second_folder,
                           const MeasureOptions& how, const fs::path& out) {
  refuse_folders_of_runs(out, {first_folder, second_folder});
  Side first(first_folder), second(second_folder);
  const std::vector<Pair> pairs = matched_frames(first.run, second.run);
  for (Side* side : {&first, &second})
    side->measured = measure_run(side->run, {{}, {}, {}, how.ahead, false});
  const Alike same = alike(first, second);
  hold_together(first, second, pairs, same);
  RunComparison compared = compare(compared_run(first, pairs, 0), compared_run(second, pairs, 1));
  compared.remarks = remarks_on(first, second, same, pairs.size());
  compared.speedup = speedup_of(first, second);
  for (const Limit& limit : how.limits)
    compared.checks.push_back(check_limit(limit, compared.differences, compared.summary));
  write_comparison(compared, first, second, out);
  return compared;
}

}  // namespace sinew
