// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_files.h"
#include "scene_rig.h"

#include <algorithm>

#include "config/scene.h"
#include "core/dataset.h"
#include "core/error.h"
#include "core/file.h"

namespace sinew {
namespace {

constexpr std::size_t read_at_once = 2;  // frames: each is large, and more would not come sooner

std::vector<PvdRow> rows_of(const RunFolder& folder, const char* series) {
  return read_pvd(folder.path / (std::string(series) + ".pvd"));
}

/// Runs `job`; what it throws is told of `file`.
template <class Job>
auto told_of(const std::filesystem::path& file, Job&& job) {
  try {
    return job();
  } catch (const Error& error) {
    throw error.within(Place{file.string()});
  }
}

Error of_another_body(const std::filesystem::path& file, const char* what) {
  return bad_input(Place{file.string()},
                   std::string("has another number of ") + what + " than the run",
                   "run the scene again with --force");
}

Triangles rest_surface(const RunFolder& folder, const PvdRow& first) {
  const auto file = folder.path / first.file;
  const Dataset data = read_vtu(file);
  if (data.kind != CellKind::triangle)
    throw bad_input(Place{file.string()}, "does not hold triangles", "run the scene again");
  const Points moved = told_of(file, [&] { return vectors(data.point_columns, "displacement"); });
  Triangles surface;
  surface.points = data.points;
  for (std::size_t i = 0; i < moved.size(); ++i) surface.points[i] -= moved[i];
  for (std::size_t c = 0; c < data.cells(); ++c)
    surface.faces.push_back(
        {data.connectivity[3 * c], data.connectivity[3 * c + 1], data.connectivity[3 * c + 2]});
  return surface;
}

double field(const Dataset& data, const char* name) {
  const auto& values = numbers(data.field_columns, name);
  return values.empty() ? 0 : values.front();
}

Energies energies_of(const Dataset& data) {
  return {field(data, "kinetic_energy"), field(data, "pair_energy"),   field(data, "bone_energy"),
          field(data, "gravity_energy"), field(data, "work_of_bones"), field(data, "dissipation"),
          field(data, "contact_energy"), field(data, "work_of_world")};
}

void read_particles(const RunFiles& run, std::size_t index, RunFrame& frame) {
  const auto file = run.folder.path / run.particle_rows[index].file;
  const Dataset data = read_vtu(file, {"displacement", "velocity"});
  if (data.points.size() != run.body.particles.size()) throw of_another_body(file, "particles");
  told_of(file, [&] {
    frame.positions = vectors(data.point_columns, "displacement");
    frame.displacement.resize(frame.positions.size());
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
      frame.displacement[i] = frame.positions[i].norm();
      frame.positions[i] += run.body.particles.position(i);
    }
    frame.velocities = vectors(data.point_columns, "velocity");
    frame.energies = energies_of(data);
  });
}

void read_surface_points(const RunFiles& run, std::size_t index, RunFrame& frame) {
  const auto file = run.folder.path / run.surface_rows[index].file;
  Dataset data = read_vtu(file, {});
  if (data.points.size() != run.surface.points.size()) throw of_another_body(file, "points");
  frame.surface_points = std::move(data.points);
}

void read_bones(const RunFiles& run, std::size_t index, RunFrame& frame) {
  const auto file = run.folder.path / run.frame_rows[index].file;
  const Dataset data = read_vtu(file);
  if (data.points.size() != run.skeleton.size()) throw of_another_body(file, "bones");
  told_of(file, [&] {
    const Points x = vectors(data.point_columns, "axis_x");
    const Points y = vectors(data.point_columns, "axis_y");
    const Points z = vectors(data.point_columns, "axis_z");
    frame.bone_lengths = numbers(data.point_columns, "length");
    for (std::size_t b = 0; b < data.points.size(); ++b) {
      RigidFrame bone{data.points[b], Mat3::Identity()};
      bone.rotation << x[b], y[b], z[b];
      frame.bones.push_back(bone);
    }
  });
}

}  // namespace

RunFiles open_run(const RunFolder& folder) {
  if (!folder.used())
    throw bad_input(Place{folder.path.string()}, "is not the folder of a run",
                    "give the folder that sinew run or sinew simulate has written");
  RunFiles run;
  run.folder = folder;
  run.scene_text = read_file(folder.scene());
  run.settings = read_scene(folder.scene());
  run.skeleton = rig_of(run.settings).skeleton;
  run.body = read_body(folder.body());
  if (!run.body.bone)
    throw bad_input(Place{folder.body().string()}, "has no array 'bone'",
                    "run the scene again with --force");
  run.particle_rows = rows_of(folder, "particles");
  run.surface_rows = rows_of(folder, "surface");
  run.frame_rows = rows_of(folder, "frames");
  const std::size_t frames =
      std::min({run.particle_rows.size(), run.surface_rows.size(), run.frame_rows.size()});
  if (frames == 0)
    throw bad_input(Place{folder.path.string()}, "the run has no frames", "run the scene again");
  for (auto* rows : {&run.particle_rows, &run.surface_rows, &run.frame_rows}) rows->resize(frames);
  run.surface = rest_surface(folder, run.surface_rows.front());
  return run;
}

RunFrame read_frame(const RunFiles& run, std::size_t index) {
  RunFrame frame;
  frame.time = run.particle_rows[index].time;
  read_particles(run, index, frame);
  read_surface_points(run, index, frame);
  read_bones(run, index, frame);
  return frame;
}

FramesInOrder::FramesInOrder(const RunFiles& run, bool ahead) : run_(run), ahead_(ahead) {
  for (std::size_t i = 0; i < (ahead_ ? read_at_once : 1); ++i) begin();
}

RunFrame FramesInOrder::next() {
  RunFrame frame = coming_.front().get();
  coming_.pop_front();
  begin();
  return frame;
}

void FramesInOrder::begin() {
  if (index_ == run_.frames()) return;
  coming_.push_back(std::async(ahead_ ? std::launch::async : std::launch::deferred,
                               [&run = run_, index = index_++] { return read_frame(run, index); }));
}

}  // namespace sinew
