// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/measure_run.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <sinew/core/dataset.h>
#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/io/series.h>
#include <sinew/io/vtk/vtk_mesh.h>
#include <sinew/mesh/clean.h>
#include <sinew/mesh/surface_gap.h>
#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/particle_values.h>
#include <sinew/metrics/report/charts.h>
#include <sinew/metrics/summary.h>
#include <sinew/metrics/table.h>
#include <sinew/repair/self_intersections.h>
#include <sinew/run/report_input.h>
#include <sinew/run/run_files.h>
#include <sinew/run/world_shown.h>

namespace sinew {

namespace {

constexpr double same_time = 1e-6;  // s

/// The skin with each point moved rigidly by its bone; nothing where a point has none.
std::optional<Triangles> rigid_pose(const RunFiles& run, const FrameState& state) {
  Triangles posed{Points(run.surface.points.size()), run.surface.faces};
  for (std::size_t i = 0; i < posed.points.size(); ++i) {
    const std::int32_t bone = run.surface_bone[i];
    if (bone < 0) return std::nullopt;
    posed.points[i] =
        carried(run.surface.points[i], run.skeleton.bones[bone].rest, state.bones[bone]);
  }
  return posed;
}

template <class Read>
std::optional<Triangles> surface_at(const SurfaceSeries& series, double time, const Read& read) {
  const auto frame = frame_at(series.rows, time);
  if (!frame) return std::nullopt;
  return read(series.folder / series.rows[*frame].file);
}

/// Triangles as they are in the file, with all of its points; other polygons are cut into such.
Triangles read_reference(const std::filesystem::path& file) {
  const PolygonSoup soup = read_vtk_mesh(file);
  Triangles surface{soup.points, {}};
  for (const auto& polygon : soup.polygons) {
    if (polygon.size() != 3) return clean(soup).triangles;
    surface.faces.push_back({polygon[0], polygon[1], polygon[2]});
  }
  return surface;
}

struct GapMetrics {
  double FrameMetrics::*hausdorff;
  double FrameMetrics::*mean;
};

void add_gap(FrameMetrics& out, const GapMetrics& to, const FaceTree& surface,
             const std::optional<Triangles>& other) {
  if (!other) return;
  const SurfaceGap gap = surface_gap(surface, FaceTree(*other));
  out.*to.hausdorff = gap.hausdorff;
  out.*to.mean = gap.mean;
}

/// Point by point, where both have the same mesh.
void add_point_distances(FrameMetrics& out, const Triangles& surface, const Triangles& other) {
  if (surface.faces != other.faces || surface.points.size() != other.points.size()) return;
  const Statistics apart = statistics(surface.points.size(), [&](std::size_t i) {
    return (surface.points[i] - other.points[i]).norm();
  });
  out.reference_surface_rms = apart.rms();
  out.reference_surface_max = apart.max();
}

}  // namespace

SurfaceSeries open_surfaces(const std::filesystem::path& pvd) {
  SurfaceSeries series{pvd.parent_path(), read_pvd(pvd)};
  if (series.rows.empty())
    throw bad_input(Place{pvd.string()}, "names no frames", "give the surface.pvd of a run");
  std::set<double> times;
  for (const PvdRow& row : series.rows)
    if (!times.insert(row.time).second)
      throw bad_input(Place{pvd.string()},
                      "has several parts at the time " + number_text(row.time) + " s",
                      "save the surface as one part: in ParaView, Merge Blocks");
  return series;
}

std::optional<std::size_t> frame_at(const std::vector<PvdRow>& rows, double time) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const PvdRow& row) {
    return std::abs(row.time - time) <= same_time;
  });
  if (found == rows.end()) return std::nullopt;
  return static_cast<std::size_t>(found - rows.begin());
}

Triangles read_surface_frame(const std::filesystem::path& file) {
  Dataset data = read_vtu(file, {});
  if (data.kind != CellKind::triangle || data.cells() == 0 || !all_finite(data.points))
    throw bad_input(Place{file.string()}, "does not hold a surface of triangles",
                    "give the surface series of a run");
  Triangles surface{std::move(data.points), {}};
  for (std::size_t c = 0; c < data.cells(); ++c)
    surface.faces.push_back(
        {data.connectivity[3 * c], data.connectivity[3 * c + 1], data.connectivity[3 * c + 2]});
  return surface;
}

void add_surface_metrics(FrameMetrics& out, const RunFiles& run, const FrameState& state,
                         const std::optional<SurfaceSeries>& reference, std::size_t at_rest) {
  using M = FrameMetrics;
  const FaceTree surface({state.surface_points, run.surface.faces});
  const std::size_t pairs = self_intersections(surface).pairs;
  out.self_intersections = static_cast<double>(pairs - std::min(pairs, at_rest));
  add_gap(out, {&M::pose_hausdorff, &M::pose_distance_mean}, surface, rigid_pose(run, state));
  const std::filesystem::path& folder = run.folder.path;
  add_gap(out, {&M::lbs_hausdorff, &M::lbs_distance_mean}, surface,
          surface_at({folder, run.lbs_rows}, state.time, read_surface_frame));
  add_gap(out, {&M::dqs_hausdorff, &M::dqs_distance_mean}, surface,
          surface_at({folder, run.dqs_rows}, state.time, read_surface_frame));
  if (!reference) return;
  const auto other = surface_at(*reference, state.time, read_reference);
  add_gap(out, {&M::reference_hausdorff, &M::reference_distance_mean}, surface, other);
  if (other) add_point_distances(out, surface.surface(), *other);
}

namespace {

/// Worst frames are added to the playback even where it leaves others out.
void add_worst_frames(Measured& measured, const RestBody& rest, const RunFiles& run) {
  for (const std::string_view name : headline_metrics()) {
    const auto worst = measured.summary.metrics[metric_index(name)].worst_frame;
    if (!worst || measured.playback.has(*worst)) continue;
    const FrameState state = read_frame(run, *worst);
    add_frame(measured.playback, *worst, rest, state, particle_values(rest, state));
  }
}

/// Finds the ranges of the playback's fields.
class FieldRanges {
 public:
  void add(const ParticleValues& particles) {
    for (std::size_t f = 0; f < found_.size(); ++f)
      found_[f].add(particles.*playback_fields()[f].values);
  }

  /// Ranges that the run has, and those found of other quantities.
  ValueRanges ranges(const ValueRanges& of_run) const {
    ValueRanges all = of_run;
    for (std::size_t f = 0; f < found_.size(); ++f)
      if (!found_[f].empty())
        all.try_emplace(std::string(playback_fields()[f].quantity), found_[f].range());
    return all;
  }

 private:
  std::vector<RangeFinder> found_ = std::vector<RangeFinder>(playback_fields().size());
};

/// Data of all frames in order, besides their metrics.
struct Course {
  std::vector<std::vector<RigidFrame>> poses;
  std::vector<double> times;
  std::vector<std::vector<std::int64_t>> worst_particles;
  FieldRanges ranges;
  std::size_t meeting_at_rest = 0;  ///< pairs of faces of the surface
};

/// Requested arrays, in addition to the run's own series.
class ValueSeries {
 public:
  ValueSeries(const RunFiles& run, std::vector<std::string_view> arrays)
      : ids_(run.ids), arrays_(std::move(arrays)) {
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
    data.point_columns.push_back(
        column("id", ids_.empty() ? vertex_cells(data.points.size()) : ids_));
    series_->add(data);
  }

  void close() {
    if (series_) series_->close();
  }

 private:
  const std::vector<std::int32_t>& ids_;
  std::vector<std::string_view> arrays_;
  std::optional<Series> series_;
};

/// Turn of the limb that is farthest from its bone, degrees.
double largest_turn(std::span<const BoneMetrics> bones) {
  Statistics turns;
  for (const BoneMetrics& bone : bones)
    if (!std::isnan(bone.turn_error)) turns.add(bone.turn_error);
  return turns.max();
}

void measure_one(Measured& measured, Course& course, const RestBody& rest, const RunFiles& run,
                 const FrameState& state, const MeasureOptions& how) {
  const std::size_t i = measured.frames.size();
  MeasuredFrame frame = measure_frame(rest, state);
  add_surface_metrics(frame.metrics, run, state, how.reference, course.meeting_at_rest);
  const std::vector<BoneMetrics> bones = measure_bones(rest, state, frame.particles);
  frame.metrics.limb_turn_max = largest_turn(bones);
  measured.frames.push_back(frame.metrics);
  measured.bones.insert(measured.bones.end(), bones.begin(), bones.end());
  for (const SectionMetrics& row :
       measure_sections(rest.sections, measured_surface(rest, state).points, state.time))
    measured.sections.push_back(row);
  if (measured.playback.wants(i)) add_frame(measured.playback, i, rest, state, frame.particles);
  course.ranges.add(frame.particles);
  course.worst_particles.push_back(std::move(frame.worst_particles));
  course.poses.push_back(state.bones);
  course.times.push_back(state.time);
}

/// Measures all frames; `state` is the first one, and `frames` has the others.
Course measure_frames(Measured& measured, const RestBody& rest, const RunFiles& run,
                      FrameState state, FramesInOrder& frames, const MeasureOptions& how) {
  Course course;
  course.meeting_at_rest = self_intersections(run.surface).pairs;
  FrameState first = state_at_rest(rest);
  first.von_mises = state.von_mises;
  ValueSeries values(run, defined_arrays(rest, first, how.arrays));
  for (std::size_t i = 0; i < run.frames(); ++i) {
    if (i > 0) state = frames.next();
    measure_one(measured, course, rest, run, state, how);
    values.add(rest, state);
    if (how.progress) how.progress(i + 1, run.frames());
  }
  values.close();
  return course;
}

}  // namespace

RestBody rest_of(const RunFiles& run, const FrameState& first) {
  RestInput input = measured_body(run);
  input.start = first.energies;
  return rest_body(std::move(input));
}

RestBody rest_of(const RunFiles& run) { return rest_of(run, read_frame(run, 0)); }

Measured measure_run(const RunFiles& run, const MeasureOptions& how) {
  FramesInOrder frames(run, how.ahead);
  FrameState first = frames.next();
  const RestBody rest = rest_of(run, first);
  Measured measured;
  if (how.playback) measured.playback = plan_playback(rest, run.frames());
  measured.playback.front = front_in(run, first).value_or(Vec3::Zero());
  const Course course = measure_frames(measured, rest, run, std::move(first), frames, how);
  const double radius = run.body.particles.radius;
  std::vector<Hold> stills = holds(course.poses, radius);
  for (Hold& hold : stills)
    hold.settled = settling_time(hold, course.times, radius,
                                 [&](std::size_t i) { return read_frame(run, i).positions; });
  measured.summary = summarize(measured.frames, radius, std::move(stills));
  add_worst_particles(measured.summary, course.worst_particles);
  measured.ranges = measured.playback.ranges = course.ranges.ranges(run.ranges);
  for (const Limit& limit : how.limits)
    measured.checks.push_back(check_limit(limit, measured.frames, measured.summary));
  if (!how.playback) return measured;
  add_worst_frames(measured, rest, run);
  show_world(measured.playback, run, [](std::size_t frame) { return frame; });
  return measured;
}

}  // namespace sinew
