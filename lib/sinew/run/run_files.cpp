// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/run_files.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include <sinew/core/dataset.h>
#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/mesh/refine.h>
#include <sinew/rig/front.h>
#include <sinew/rig/skin.h>
#include <sinew/run/run_record.h>
#include <sinew/scene/frame_content.h>
#include <sinew/scene/prepare.h>
#include <sinew/scene/rig.h>
#include <sinew/scene/world.h>
#include <sinew/settings/read_scene.h>

namespace sinew {

namespace {

constexpr std::size_t read_ahead = 1;  // frames: each is large

std::vector<PvdRow> rows_of(const RunFolder& folder, const char* series) {
  return read_pvd(folder.path / (std::string(series) + ".pvd"));
}

/// Runs `job`; errors it throws name `file`.
template <class Job>
auto told_of(const std::filesystem::path& file, Job&& job) {
  try {
    return job();
  } catch (const Error& error) {
    throw error.with_context(Place{file.string()});
  }
}

Error of_another_body(const std::filesystem::path& file, const char* what) {
  return bad_input(Place{file.string()},
                   std::string("has another number of ") + what + " than the run",
                   "run the scene again with --force");
}

/// The rows of an optional series.
std::vector<PvdRow> rows_if_there(const RunFolder& folder, const char* series) {
  std::error_code unreachable;
  const bool there =
      std::filesystem::exists(folder.path / (std::string(series) + ".pvd"), unreachable);
  return there ? rows_of(folder, series) : std::vector<PvdRow>();
}

std::vector<std::array<int, 3>> triangles_in(const Dataset& data) {
  std::vector<std::array<int, 3>> faces;
  for (std::size_t c = 0; c < data.cells(); ++c)
    faces.push_back(
        {data.connectivity[3 * c], data.connectivity[3 * c + 1], data.connectivity[3 * c + 2]});
  return faces;
}

/// The skin at rest, and the bone of each of its points.
void read_rest_surface(RunFiles& run) {
  const auto file = run.folder.path / run.surface_rows.front().file;
  const Dataset data = read_vtu(file);
  if (data.kind != CellKind::triangle)
    throw bad_input(Place{file.string()}, "does not hold triangles", "run the scene again");
  const Points moved = told_of(file, [&] { return vectors(data.point_columns, "displacement"); });
  run.surface_bone = told_of(file, [&] { return integers(data.point_columns, "bone"); });
  for (const std::int32_t bone : run.surface_bone)
    if (bone < -1 || bone >= static_cast<std::int32_t>(run.skeleton.size()))
      throw bad_input(Place{file.string()},
                      "names bone " + std::to_string(bone) + ", which the run does not have",
                      "run the scene again with --force");
  Triangles& surface = run.surface;
  surface.points = data.points;
  for (std::size_t i = 0; i < moved.size(); ++i) surface.points[i] -= moved[i];
  surface.faces = triangles_in(data);
}

double field(const Dataset& data, const char* name) {
  const auto& values = numbers(data.field_columns, name);
  const double value = values.empty() ? 0 : values.front();
  if (!std::isfinite(value))
    throw bad_input(std::string(name) + " is not finite", "run the scene again with --force");
  return value;
}

/// Work and dissipation are in frames of bodies that move, what is unbalanced in those of bodies at
/// rest; else not-a-number.
double field_if_there(const Dataset& data, const char* name) {
  return find(data.field_columns, name) ? field(data, name)
                                        : std::numeric_limits<double>::quiet_NaN();
}

Energies energies_of(const Dataset& data) {
  return {field(data, "kinetic_energy"),
          field(data, "pair_energy"),
          field(data, "bone_energy"),
          field(data, "gravity_energy"),
          field_if_there(data, "work_of_bones"),
          field_if_there(data, "dissipation"),
          field(data, "contact_energy"),
          field_if_there(data, "work_of_world")};
}

/// Uses the displacements, where they are written: these are exact for small ones.
Points positions_in(const RunFiles& run, const Dataset& data) {
  if (!find(data.point_columns, "displacement")) return data.points;
  Points positions = vectors(data.point_columns, "displacement");
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += run.body.particles.position(i);
  return positions;
}

void read_particles(const RunFiles& run, std::size_t index, FrameState& frame) {
  const auto file = run.folder.path / run.particle_rows[index].file;
  const Dataset data = read_vtu(
      file, {"displacement", "velocity", "broken_bonds", "von_mises", "group", "force_world"});
  if (data.points.size() != run.body.particles.size()) throw of_another_body(file, "particles");
  told_of(file, [&] {
    frame.positions = positions_in(run, data);
    if (find(data.point_columns, "velocity"))
      frame.velocities = vectors(data.point_columns, "velocity");
    frame.energies = energies_of(data);
    frame.unbalanced = {field_if_there(data, "unbalanced_force"),
                        field_if_there(data, "unbalanced_moment")};
    if (find(data.point_columns, "broken_bonds") && run.ids.empty())  // else some bonds are missing
      frame.broken_bonds = integers(data.point_columns, "broken_bonds");
    if (find(data.point_columns, "group")) frame.group = integers(data.point_columns, "group");
    if (find(data.point_columns, "von_mises"))
      frame.von_mises = numbers(data.point_columns, "von_mises");
    if (find(data.point_columns, "force_world"))
      frame.world_force = vectors(data.point_columns, "force_world");
  });
}

void read_surface_points(const RunFiles& run, std::size_t index, FrameState& frame) {
  const auto file = run.folder.path / run.surface_rows[index].file;
  Dataset data = read_vtu(file, {});
  if (data.points.size() != run.surface.points.size()) throw of_another_body(file, "points");
  frame.surface_points = std::move(data.points);
}

/// Refuses axes that are not a rotation and lengths that are not positive.
void check_bone(const RigidFrame& bone, double length, std::size_t index) {
  constexpr double rounding = 1e-3;  // far above that of single precision
  const Mat3 product = bone.rotation.transpose() * bone.rotation;
  if (!product.isIdentity(rounding) || !(std::isfinite(length) && length > 0))
    throw bad_input("bone " + std::to_string(index) + " has no length or axes at no right angles",
                    "run the scene again with --force");
}

void read_bones(const RunFiles& run, std::size_t index, FrameState& frame) {
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
      check_bone(bone, frame.bone_lengths[b], b);
      frame.bones.push_back(bone);
    }
  });
}

/// Drops rows of frames that some series lack; checks that the others have the same times.
void trim_rows(RunFiles& run) {
  const std::array<std::pair<const char*, std::vector<PvdRow>*>, 3> series{
      {{"particles.pvd", &run.particle_rows},
       {"surface.pvd", &run.surface_rows},
       {"frames.pvd", &run.frame_rows}}};
  std::size_t frames = run.particle_rows.size();
  for (const auto& [name, rows] : series) {
    frames = std::min(frames, rows->size());
    run.frames_named = std::max(run.frames_named, rows->size());
  }
  if (frames == 0) throw without_frames(run.folder);
  for (const auto& [name, rows] : series) {
    rows->resize(frames);
    for (std::size_t i = 0; i < frames; ++i)
      if ((*rows)[i].time != run.particle_rows[i].time)
        throw bad_input(Place{(run.folder.path / name).string()},
                        "has a frame at " + number_text((*rows)[i].time) +
                            " s where particles.pvd has one at " +
                            number_text(run.particle_rows[i].time) + " s",
                        "run the scene again with --force");
  }
}

/// Picks the first of each so many rows: the moments at which particles are written.
std::vector<PvdRow> thinned(const std::vector<PvdRow>& rows, int every) {
  std::vector<PvdRow> some;
  for (std::size_t i = 0; i < rows.size(); i += static_cast<std::size_t>(every))
    some.push_back(rows[i]);
  return some;
}

template <class T>
void keep(const std::vector<std::int32_t>& ids, std::vector<T>& values) {
  for (std::size_t k = 0; k < ids.size(); ++k) values[k] = values[static_cast<std::size_t>(ids[k])];
  values.resize(ids.size());
}

/// Keeps the particles that the frames contain, numbered anew.
void keep_written(RunFiles& run) {
  Particles& all = run.body.particles;
  run.ids = written_particles(run.settings.output, positions_of(all), all.radius);
  if (run.ids.empty()) return;
  for (const auto axis :
       {&Particles::x, &Particles::y, &Particles::z, &Particles::u, &Particles::v, &Particles::w})
    keep(run.ids, all.*axis);
  all.id.resize(run.ids.size());  // they are 0, 1, 2, ...
  keep(run.ids, run.body.neighbors);
  keep(run.ids, run.body.component);
  if (run.body.bone) keep(run.ids, *run.body.bone);
  if (run.body.weight) keep(run.ids, *run.body.weight);
  if (run.body.volume_share) keep(run.ids, *run.body.volume_share);
  if (run.body.stiffness) keep(run.ids, *run.body.stiffness);
  if (run.body.density) keep(run.ids, *run.body.density);
  if (run.body.volume_stiffness) keep(run.ids, *run.body.volume_stiffness);
}

}  // namespace

RunFiles open_run(const RunFolder& folder) {
  if (!folder.used())
    throw bad_input(Place{folder.path.string()}, "is not the folder of a run",
                    "give the folder that sinew run or sinew simulate has written");
  refuse_without_frames(folder);
  RunFiles run;
  run.folder = folder;
  run.scene_text = read_file(folder.scene());
  run.settings = read_scene(folder.scene());
  run.skeleton = rig_of(run.settings, read_rig_files(run.settings)).skeleton;
  run.body = read_body(folder.body());
  if (!run.body.bone)
    throw bad_input(Place{folder.body().string()}, "has no array 'bone'",
                    "run the scene again with --force");
  run.material = material_of(run.settings, run.body.particles);
  keep_written(run);
  const int every = run.settings.output.every;
  run.particle_rows = rows_of(folder, "particles");
  run.surface_rows = thinned(rows_of(folder, "surface"), every);
  const std::vector<PvdRow> moments = rows_of(folder, "frames");
  run.frame_rows = thinned(moments, every);
  trim_rows(run);
  if (run.frames() == run.frames_named) run.frames_run = moments.size();
  run.lbs_rows = thinned(rows_if_there(folder, "skin_lbs"), every);
  run.dqs_rows = thinned(rows_if_there(folder, "skin_dqs"), every);
  run.obstacle_rows = thinned(rows_if_there(folder, "obstacles"), every);
  run.support_rows = thinned(rows_if_there(folder, "supports"), every);
  run.bond_rows = rows_if_there(folder, "bonds");
  read_rest_surface(run);
  run.ranges = recorded_ranges(folder);
  return run;
}

std::optional<Vec3> front_in(const RunFiles& run, const FrameState& frame) {
  std::vector<std::string> names;
  Points heads, tails;
  for (std::size_t b = 0; b < frame.bones.size(); ++b) {
    names.push_back(run.skeleton.bones[b].name);
    heads.push_back(frame.bones[b].origin);
    tails.push_back(heads.back() + frame.bone_lengths[b] * frame.bones[b].rotation.col(0));
  }
  return names.empty() ? std::nullopt : front_of(names, heads, tails);
}

FrameState read_frame(const RunFiles& run, std::size_t index) {
  FrameState frame;
  frame.time = run.particle_rows[index].time;
  read_particles(run, index, frame);
  read_surface_points(run, index, frame);
  read_bones(run, index, frame);
  return frame;
}

std::vector<double> displacements(const RunFiles& run, const FrameState& frame) {
  std::vector<double> far(frame.positions.size());
  for (std::size_t i = 0; i < far.size(); ++i)
    far[i] = (frame.positions[i] - run.body.particles.position(i)).norm();
  return far;
}

Triangles read_obstacles(const RunFiles& run, std::size_t index) {
  if (index >= run.obstacle_rows.size()) return {};
  const auto file = run.folder.path / run.obstacle_rows[index].file;
  Dataset data = read_vtu(file, {});
  if (data.kind != CellKind::triangle)
    throw bad_input(Place{file.string()}, "does not hold triangles", "run the scene again");
  return {std::move(data.points), triangles_in(data)};
}

namespace {

/// Each particle on the bone that holds it most.
Binding bound_to(const std::vector<std::int32_t>& bones) {
  Binding binding{{0}, {}, {}};
  for (const std::int32_t bone : bones) {
    if (bone != no_bone) binding.influences.push_back({bone, 1});
    binding.first.push_back(static_cast<std::uint32_t>(binding.influences.size()));
  }
  return binding;
}

SceneWorld scene_world(const RunFiles& run) {
  Settings settings = run.settings;
  settings.world.obstacles.clear();  // their meshes need not exist any more
  settings.materials.clear();        // nor those of parts
  const BodyFile read = run.ids.empty() ? BodyFile() : read_body(run.folder.body());
  const BodyFile& body = run.ids.empty() ? run.body : read;
  SceneFiles files;
  files.surface = run.surface;
  Body bound;
  bound.rest = positions_of(body.particles);
  bound.skeleton = run.skeleton;
  bound.binding = bound_to(*body.bone);
  bound.material = run.material;
  if (!settings.world.muscles.empty()) {  // they pull with all weights of their bones
    files = read_rig_files(settings);
    files.surface = run.surface;
    bound = make_body(settings, files, run.skeleton, body.particles, local_material(body));
  }
  return world_of(settings, files, bound, body.component);
}

}  // namespace

std::shared_ptr<const World> world_of_run(const RunFiles& run) {
  if (run.settings.world.pins.empty() && run.settings.world.muscles.empty() &&
      run.settings.supports.empty() && run.settings.loads.empty() &&
      run.settings.world.springs.empty())
    return nullptr;
  return scene_world(run).world;
}

std::vector<Probe> probes_of_run(const RunFiles& run) {
  if (run.settings.probes.empty()) return {};
  if (!run.ids.empty())
    throw bad_input(Place{run.folder.path.string()}, "has not written all particles",
                    "run the scene without output.region and output.inside_every");
  return scene_world(run).probes;
}

FramesInOrder::FramesInOrder(const RunFiles& run, bool ahead) : run_(run), ahead_(ahead) {
  for (std::size_t i = 0; i < read_ahead; ++i) begin();
}

FrameState FramesInOrder::next() {
  FrameState frame = coming_.front().get();
  coming_.pop_front();
  begin();
  return frame;
}

void FramesInOrder::begin() {
  if (index_ == run_.frames()) return;
  coming_.push_back(std::async(ahead_ ? std::launch::async : std::launch::deferred,
                               [&run = run_, index = index_++] { return read_frame(run, index); }));
}

namespace {

/// The bones whose flesh passed through each other in a run, as its record names them.
PassThrough passing_of(const RunFiles& run) {
  const nlohmann::ordered_json record = read_record(run.folder);
  std::vector<PassThrough::Pair> pairs;
  const auto index = [&](const nlohmann::ordered_json& name) {
    const auto& bones = run.skeleton.bones;
    const auto at = std::find_if(bones.begin(), bones.end(),
                                 [&](const Bone& bone) { return name == bone.name; });
    return at == bones.end() ? no_bone : static_cast<int>(at - bones.begin());
  };
  const auto found = record.find("pass_through");
  if (found == record.end() || !found->is_array()) return {};
  for (const auto& pair : *found) {
    if (!pair.is_array() || pair.size() != 2) continue;
    const int a = index(pair[0]), b = index(pair[1]);
    if (a != no_bone && b != no_bone) pairs.push_back({a, b});
  }
  return {run.skeleton.size(), pairs};
}

/// The layers of the particles that frames contain, in the whole body.
std::vector<std::int32_t> layers_of_part(const RunFiles& run) {
  const Points rest = positions_of(read_body(run.folder.body()).particles);
  const double r = run.material.pair.r;
  const auto all = surface_layers(rest_shape(rest, rest_neighbor_range(r)), r);
  std::vector<std::int32_t> layer;
  for (const std::int32_t id : run.ids) layer.push_back(all[static_cast<std::size_t>(id)]);
  return layer;
}

/// The surface in triangles that bend as the particles do; none where its own are so small, or not
/// all particles are in the frames.
std::optional<FineSkin> fine_skin(const RunFiles& run) {
  const double r = run.material.pair.r;
  const double side = longest_measured_side * r, faces = area(run.surface) / (side * side);
  if (!run.ids.empty() || longest_side(run.surface) <= side) return {};
  // A skin that is not around the particles is damaged: whoever measures it says so.
  constexpr double max_faces_per_particle = 10;
  if (!(faces < max_faces_per_particle * static_cast<double>(run.body.particles.size()))) return {};
  FineSkin fine{refined(run.surface, longest_measured_side * r), {}};
  const auto made = [&run, r, points = fine.rest.points] {  // where it is asked for
    return make_skin(points, positions_of(run.body.particles), r, run.skeleton,
                     bound_to(*run.body.bone));
  };
  fine.at = [skin = std::async(std::launch::deferred, made).share()](const Points& now) {
    const auto mine = skin;  // several threads may ask
    return follow(mine.get(), now);
  };
  return fine;
}

}  // namespace

RestInput measured_body(const RunFiles& run) {
  RestInput input;
  input.positions = positions_of(run.body.particles);
  input.neighbors = std::make_shared<const RestNeighbors>(
      rest_neighbors(input.positions, run.material.pair.r, run.material.bond.second > 0));
  input.surface = run.surface;
  input.fine = fine_skin(run);
  input.bone.assign(run.body.bone->begin(), run.body.bone->end());
  input.weight = run.body.weight.value_or(std::vector<double>{});
  input.skeleton = run.skeleton;
  input.material = run.material;
  input.density = run.body.density.value_or(std::vector<double>{});
  RestForces& forces = input.forces;
  if (!run.ids.empty()) {  // particles that are not there act as well
    input.layer = layers_of_part(run);
    forces.known = false;
    return input;
  }
  LocalMaterial local = local_material(run.body);
  forces.stiffness = std::move(local.stiffness);
  forces.volume_share = std::move(local.volume_share);
  forces.volume_stiffness = run.body.volume_stiffness.value_or(std::vector<double>{});
  forces.has_muscles = !run.settings.world.muscles.empty();
  if (run.settings.contact.pass_through.any()) forces.pass = passing_of(run);
  return input;
}

}  // namespace sinew
