// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/measure_run.h"

#include "core/dataset.h"
#include "folder/measured_body.h"
#include "io/series.h"
#include "measure/law_curves.h"
#include "metrics/measure.h"
#include "metrics/particle_arrays.h"
#include "metrics/report/charts.h"
#include "metrics/settling.h"
#include "metrics/table.h"

namespace sinew {
namespace {

/// Frames that one goes to look at are in the film even where it leaves others out.
void add_worst_frames(Measured& measured, const RestBody& rest, const RunFiles& run) {
  for (const std::string_view name : telling_metrics()) {
    const auto worst = measured.summary.metrics[metric_index(name)].worst_frame;
    if (!worst || measured.film.has(*worst)) continue;
    const FrameState state = measured_frame(read_frame(run, *worst));
    add_frame(measured.film, *worst, rest, state, particle_values(rest, state));
  }
}

/// What the frames were like in order, beside their metrics.
struct Course {
  std::vector<std::vector<RigidFrame>> poses;
  std::vector<double> times;
  std::vector<std::vector<std::int64_t>> worst_particles;
};

/// Arrays that were asked for, beside the run's own series.
class ValueSeries {
 public:
  ValueSeries(const RunFiles& run, const std::vector<std::string_view>& arrays) : arrays_(arrays) {
    if (arrays_.empty()) return;
    const OutputSettings& output = run.settings.output;
    series_.emplace(run.folder.path, VtuFormat{output.encoding, output.double_precision, "values",
                                               run.body.particles.radius});
  }

  void add(const RestBody& rest, const FrameState& state) {
    if (!series_) return;
    Dataset data;
    data.time = state.time;
    data.points = state.positions;
    data.connectivity = vertex_cells(data.points.size());
    data.point_columns = particle_arrays(rest, state, arrays_);
    data.point_columns.push_back(column("id", vertex_cells(data.points.size())));
    series_->add(data);
  }

  void close() {
    if (series_) series_->close();
  }

 private:
  std::vector<std::string_view> arrays_;
  std::optional<Series> series_;
};

void measure_one(Measured& measured, Course& course, const RestBody& rest, const RunFiles& run,
                 const FrameState& state, const HowToMeasure& how) {
  const std::size_t i = measured.frames.size();
  MeasuredFrame frame = measure_frame(rest, state);
  add_surface_metrics(frame.metrics, run, state, how.reference);
  measured.frames.push_back(frame.metrics);
  for (const BoneMetrics& bone : measure_bones(rest, state, frame.particles))
    measured.bones.push_back(bone);
  for (const SectionMetrics& row :
       measure_sections(rest.sections, state.surface_points, state.time))
    measured.sections.push_back(row);
  if (measured.film.wants(i)) add_frame(measured.film, i, rest, state, frame.particles);
  course.worst_particles.push_back(std::move(frame.worst_particles));
  course.poses.push_back(state.bones);
  course.times.push_back(state.time);
}

Course measure_frames(Measured& measured, const RestBody& rest, const RunFiles& run,
                      const HowToMeasure& how) {
  Course course;
  FramesInOrder frames(run, how.ahead);
  ValueSeries values(run, how.arrays);
  for (std::size_t i = 0; i < run.frames(); ++i) {
    const FrameState state = measured_frame(frames.next());
    measure_one(measured, course, rest, run, state, how);
    values.add(rest, state);
  }
  values.close();
  return course;
}

}  // namespace

RestBody rest_of(const RunFiles& run) {
  RestInput input = measured_body(run);
  input.start = read_frame(run, 0).energies;
  return rest_body(std::move(input));
}

Measured measure_run(const RunFiles& run, const HowToMeasure& how) {
  const RestBody rest = rest_of(run);
  Measured measured;
  if (how.film) measured.film = plan_film(rest, run.frames());
  const Course course = measure_frames(measured, rest, run, how);
  const double radius = run.body.particles.radius;
  std::vector<Hold> stills = holds(course.poses, radius);
  for (Hold& hold : stills)
    hold.settled = settling_time(hold, course.times, radius,
                                 [&](std::size_t i) { return read_frame(run, i).positions; });
  measured.summary = summarize(measured.frames, radius, std::move(stills));
  add_worst_particles(measured.summary, course.worst_particles);
  for (const Limit& limit : how.limits)
    measured.checks.push_back(check_limit(limit, measured.frames, measured.summary));
  if (how.film) add_worst_frames(measured, rest, run);
  return measured;
}

}  // namespace sinew
