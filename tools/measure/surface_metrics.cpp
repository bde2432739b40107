// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/surface_metrics.h"

#include <algorithm>
#include <cmath>

#include "core/dataset.h"
#include "core/error.h"
#include "mesh/self_intersections.h"
#include "mesh/surface_gap.h"

namespace sinew {
namespace {

constexpr double same_time = 1e-6;  // s

/// The skin with each point carried by its bone; nothing where a point has none.
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

std::optional<Triangles> surface_at(const SurfaceSeries& series, double time) {
  const auto frame = frame_at(series.rows, time);
  if (!frame) return std::nullopt;
  return read_surface_frame(series.folder / series.rows[*frame].file);
}

struct GapMetrics {
  double FrameMetrics::*hausdorff;
  double FrameMetrics::*mean;
};

void add_gap(FrameMetrics& out, const GapMetrics& to, const Triangles& surface,
             const std::optional<Triangles>& other) {
  if (!other) return;
  const SurfaceGap gap = surface_gap(surface, *other);
  out.*to.hausdorff = gap.hausdorff;
  out.*to.mean = gap.mean;
}

/// Point by point, where both are the same mesh.
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
                         const std::optional<SurfaceSeries>& reference) {
  using M = FrameMetrics;
  const Triangles surface{state.surface_points, run.surface.faces};
  out.self_intersections = static_cast<double>(self_intersections(surface).pairs);
  add_gap(out, {&M::pose_hausdorff, &M::pose_distance_mean}, surface, rigid_pose(run, state));
  const std::filesystem::path& folder = run.folder.path;
  add_gap(out, {&M::lbs_hausdorff, &M::lbs_distance_mean}, surface,
          surface_at({folder, run.lbs_rows}, state.time));
  add_gap(out, {&M::dqs_hausdorff, &M::dqs_distance_mean}, surface,
          surface_at({folder, run.dqs_rows}, state.time));
  if (!reference) return;
  const auto other = surface_at(*reference, state.time);
  add_gap(out, {&M::reference_hausdorff, &M::reference_distance_mean}, surface, other);
  if (other) add_point_distances(out, surface, *other);
}

}  // namespace sinew
