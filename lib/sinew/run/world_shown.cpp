// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/world_shown.h>

#include <algorithm>

#include <sinew/core/dataset.h>

namespace sinew {
namespace {

constexpr std::size_t max_bytes = 800'000;  // share of a page of 10 MB

/// A coarser form of the obstacles where all frames of it would not fit; the same in all frames.
ThinSurface thinned(const RunFiles& run, std::size_t frames) {
  constexpr std::size_t bytes = 36;  // a point has about two triangles, of three corners each
  const Triangles first = read_obstacles(run, 0);
  const bool moves = first.points != read_obstacles(run, run.frames() - 1).points;
  return thin_surface(first, max_bytes / (bytes * (moves ? frames : 1)));
}

Triangles picked(const Triangles& obstacles, const ThinSurface& thin) {
  Triangles some;
  for (const std::uint32_t point : thin.points) some.points.push_back(obstacles.points.at(point));
  some.faces = thin.faces;
  return some;
}

/// The materials of a playback's particles, where the scene has several and frames tell them.
void name_materials(Playback& playback, const RunFiles& run) {
  if (run.settings.materials.empty() || run.particle_rows.empty()) return;
  const Dataset data = read_vtu(run.folder.path / run.particle_rows.front().file, {"material"});
  const Column* column = find(data.point_columns, "material");
  const auto* numbers = column ? std::get_if<std::vector<std::int32_t>>(&column->values) : nullptr;
  if (numbers == nullptr) return;
  const auto most = static_cast<std::int32_t>(run.settings.materials.size());
  playback.material_names = names_of_materials(run);
  for (const std::uint32_t i : playback.particles)
    playback.material.push_back(std::clamp(numbers->at(i), 0, most));
}

void add_forces(Playback& playback, const RunFiles& run,
                const std::function<std::size_t(std::size_t)>& frame_of) {
  const ShownForces forces(run);
  for (PlaybackFrame& frame : playback.frames) {
    playback.is_load.clear();
    for (const ShownForce& one : forces.at(frame_of(frame.frame))) {
      playback.is_load.push_back(one.is_load);
      for (const Vec3& end : {one.from, Vec3(one.from + one.along)})
        append_place(frame.forces, end, playback.origin);
    }
  }
}

}  // namespace

ShownForces::ShownForces(const RunFiles& run) : run_(&run) {
  constexpr double longest = 0.2;  // fraction of the body
  double hardest = 0;
  for (const PvdRow& row : run.support_rows)
    for (const Vec3& force :
         vectors(read_vtu(run.folder.path / row.file, {"force"}).point_columns, "force"))
      hardest = std::max(hardest, force.norm());
  const double size = bounds(positions_of(run.body.particles)).diagonal().norm();
  strongest_ = hardest;
  if (hardest > 0) scale_ = longest * size / hardest;
}

std::vector<ShownForce> ShownForces::at(std::size_t frame) const {
  std::vector<ShownForce> shown;
  if (frame >= run_->support_rows.size()) return shown;
  const Dataset data =
      read_vtu(run_->folder.path / run_->support_rows[frame].file, {"force", "load"});
  const Points force = vectors(data.point_columns, "force");
  const std::vector<std::int32_t>& load = integers(data.point_columns, "load");
  for (std::size_t k = 0; k < data.points.size(); ++k)
    shown.push_back({data.points[k], scale_ * force[k], load[k] != 0});
  return shown;
}

std::vector<std::string> names_of_materials(const RunFiles& run) {
  std::vector<std::string> names = {"the rest"};
  for (const LocalMaterialSettings& one : run.settings.materials) names.push_back(one.name);
  return names;
}

std::ptrdiff_t place_in_frames(const RunFiles& run, std::size_t particle) {
  if (run.ids.empty())
    return particle < run.body.particles.size() ? static_cast<std::ptrdiff_t>(particle) : -1;
  const auto at = std::lower_bound(run.ids.begin(), run.ids.end(), particle);
  if (at == run.ids.end() || static_cast<std::size_t>(*at) != particle) return -1;
  return at - run.ids.begin();
}

std::vector<std::size_t> held_in_frames(const RunFiles& run) {
  std::vector<std::size_t> held;
  const auto world = world_of_run(run);
  if (!world) return held;
  for (const Pinned& pin : world->pins)
    if (const std::ptrdiff_t place = place_in_frames(run, pin.particle); place >= 0)
      held.push_back(static_cast<std::size_t>(place));
  std::sort(held.begin(), held.end());
  held.erase(std::unique(held.begin(), held.end()), held.end());
  return held;
}

Box obstacle_space(const Box& body) {
  constexpr double around = 0.15;  // fraction of the diagonal: enough to recognize obstacles
  const Vec3 more = Vec3::Constant(around * body.diagonal().norm());
  return Box(body.min() - more, body.max() + more);
}

namespace {

/// The particles for which the run broke off, where it has left them.
void mark_offenders(Playback& playback, const RunFiles& run) {
  if (status_of(run.folder) != "unstable" || !std::filesystem::exists(run.folder.blowup())) return;
  const Dataset data = read_vtu(run.folder.blowup(), {"offender"});
  const Column* column = find(data.point_columns, "offender");
  const auto* offence = column ? std::get_if<std::vector<std::int32_t>>(&column->values) : nullptr;
  if (offence == nullptr || offence->size() != playback.run_particles) return;
  playback.mark_names = {"others", "moved too far in the step that failed", "not finite after it"};
  for (const std::uint32_t i : playback.particles)
    playback.mark.push_back(std::clamp((*offence)[i], 0, 2));
}

}  // namespace

void show_world(Playback& playback, const RunFiles& run,
                const std::function<std::size_t(std::size_t)>& frame_of) {
  const std::vector<std::size_t> held = held_in_frames(run);
  for (std::uint32_t i = 0; i < playback.particles.size(); ++i)
    if (std::binary_search(held.begin(), held.end(), playback.particles[i]))
      playback.held.push_back(i);
  name_materials(playback, run);
  mark_offenders(playback, run);
  add_forces(playback, run, frame_of);
  if (run.obstacle_rows.empty() || playback.frames.empty()) return;
  const Box space = obstacle_space(box_of(playback));
  const ThinSurface thin = thinned(run, playback.frames.size());
  for (const PlaybackFrame& frame : playback.frames)
    add_obstacles(playback, frame.frame, space,
                  picked(read_obstacles(run, frame_of(frame.frame)), thin));
}

}  // namespace sinew
