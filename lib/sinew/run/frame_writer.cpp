// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/frame_writer.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <sinew/core/arrays.h>
#include <sinew/core/error.h>
#include <sinew/io/gltf/moving_surface.h>
#include <sinew/metrics/pair_forces.h>
#include <sinew/metrics/particle_values.h>
#include <sinew/run/detail/bond_frames.h>
#include <sinew/run/run_files.h>
#include <sinew/scene/frame_content.h>
#include <sinew/settings/text_file.h>

namespace sinew {
namespace {

VtuFormat format_of(const OutputSettings& output, const char* series, double radius) {
  VtuFormat format;
  format.encoding = output.encoding;
  format.double_precision = output.double_precision;
  format.series = series;
  format.radius = radius;
  return format;
}

/// The bone of the particle that moves each vertex most.
std::vector<std::int32_t> bones_of_vertices(const Skin& skin, const Binding& binding) {
  std::vector<std::int32_t> bones;
  for (std::size_t i = 0; i < skin.rest.size(); ++i) {
    const auto begin = skin.weight.begin() + skin.first[i];
    const auto most = std::max_element(begin, skin.weight.begin() + skin.first[i + 1]);
    bones.push_back(
        binding.bone(skin.near[skin.weighted[skin.particle[most - skin.weight.begin()]]]));
  }
  return bones;
}

/// The rows of a plain column for these particles; all of them where no ids are given.
Column rows_of(Column column, const std::vector<std::int32_t>& ids) {
  const auto select = [&](auto& values) {
    if constexpr (requires { values[0]; }) {
      const auto width = static_cast<std::size_t>(column.components);
      std::remove_reference_t<decltype(values)> some;
      some.reserve(width * ids.size());
      for (const std::int32_t id : ids) {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(width) * id;
        some.insert(some.end(), first, first + column.components);
      }
      values = std::move(some);
    }
  };
  if (!ids.empty()) std::visit(select, column.values);
  return column;
}

std::vector<double> each(std::size_t nth, std::span<const double> times) {
  std::vector<double> some;
  for (std::size_t i = 0; i < times.size(); i += nth) some.push_back(times[i]);
  return some;
}

BoneWeights weights_of_vertices(const Body& body, const Points& vertices) {
  BoneWeights weights;
  weights.first = body.binding.first;
  for (const Influence& influence : body.binding.influences)
    weights.weights.push_back({influence.bone, influence.weight});
  return carried_weights(body.rest, weights, vertices);
}

Dataset obstacles_of(const std::vector<Triangles>& surfaces, const std::vector<ObstaclePose>& poses,
                     const std::vector<Reaction>& reactions, Moment moment) {
  std::vector<ObstacleFrame> frames;
  for (std::size_t k = 0; k < surfaces.size(); ++k)
    frames.push_back({surfaces[k], poses[k].frame, poses[k].velocity, poses[k].angular_velocity,
                      reactions[k].force, reactions[k].moment});
  return obstacles_dataset(frames, moment);
}

std::vector<BoneRow> rows_of(const std::vector<Reaction>& reactions) {
  std::vector<BoneRow> rows;
  rows.reserve(reactions.size());
  for (const Reaction& on : reactions) rows.push_back({on.force, on.moment, on.power});
  return rows;
}

/// Force and moment on each bone, in separate lists.
struct ReactionColumns {
  Points force, moment;

  explicit ReactionColumns(const std::vector<Reaction>& reactions) {
    for (const Reaction& on : reactions) {
      force.push_back(on.force);
      moment.push_back(on.moment);
    }
  }
  operator Reactions() const { return {force, moment}; }
};

}  // namespace

FrameWriter::FrameWriter(const std::filesystem::path& folder, const OutputSettings& output,
                         const Body& body, FrameScene scene, std::span<const double> kept,
                         StrainInFrames strain)
    : folder_(folder),
      body_(body),
      selection_{written_particles(output, body.rest, body.material.pair.r, scene.neighbors),
                 frame_arrays(output.only)},
      every_(static_cast<std::size_t>(output.every)),
      taken_(kept.size()),
      skin_(make_skin(scene.surface.points, body.rest, body.material.pair.r, body.skeleton,
                      body.binding)),
      surface_(std::move(scene.surface)),
      surface_bone_(bones_of_vertices(skin_, body.binding)),
      obstacles_(std::move(scene.obstacles)),
      particles_(folder, format_of(output, "particles", body.material.pair.r), each(every_, kept)),
      skins_(folder, format_of(output, "surface", body.material.pair.r), kept),
      bones_(folder, format_of(output, "bones", body.material.pair.r), kept),
      frames_(folder, format_of(output, "frames", body.material.pair.r), kept),
      bone_table_(folder / "bones.csv", body.skeleton.size(), kept.size()),
      written_(static_cast<int>(kept.size())) {
  if (!obstacles_.empty())
    obstacle_series_.emplace(folder, format_of(output, "obstacles", body.material.pair.r), kept);
  if (body.world && !(body.world->supports.empty() && body.world->loads.empty())) {
    support_table_.emplace(folder / "supports.csv", *body.world, kept.size());
    support_series_.emplace(folder, format_of(output, "supports", body.material.pair.r), kept);
  }
  if (!scene.probes.empty())
    probe_table_.emplace(folder / "probes.csv", std::move(scene.probes), kept.size());
  begin_skinned(output, kept);
  if (output.export_surface) begin_export(kept.size(), std::move(scene.look));
  begin_arrays(output, std::move(scene.neighbors), kept, strain);
  begin_checksums();
}

std::vector<Series*> FrameWriter::all_series() {
  std::vector<Series*> all{&particles_, &skins_, &bones_, &frames_};
  for (auto* series : {&obstacle_series_, &support_series_, &bond_series_})
    if (*series) all.push_back(&**series);
  for (const Skinned& skinned : skinned_) all.push_back(skinned.series.get());
  return all;
}

/// Begins with checksums of kept frames, and of what was written before the frames.
void FrameWriter::begin_checksums() {
  std::set<std::string> begun{"body.vtu", "scene.yaml"}, stay = begun;
  for (const Series* series : all_series()) {
    for (const PvdRow& row : series->rows()) stay.insert(row.file);
    listed_.push_back(series->rows().size());
  }
  std::vector<Checksum> kept;
  if (written_ > 0) kept = read_checksums(folder_);
  std::erase_if(kept, [&](const Checksum& file) { return !stay.contains(file.name); });
  checksums_.emplace(folder_, kept);
  if (written_ > 0) return;
  for (const std::string& name : begun)
    if (std::filesystem::exists(folder_ / name)) checksums_->add(name);
}

void FrameWriter::list_new_frames() {
  const std::vector<Series*> all = all_series();
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (const auto& rows = all[k]->rows(); listed_[k] < rows.size(); ++listed_[k])
      checksums_->add(rows[listed_[k]].file);
  }
}

void FrameWriter::begin_skinned(const OutputSettings& output, std::span<const double> kept) {
  if (output.skin_lbs || output.skin_dqs) vertex_weights_ = weights_of_vertices(body_, skin_.rest);
  const auto begin = [&](auto* method, const char* name) {
    const VtuFormat format = format_of(output, name, body_.material.pair.r);
    skinned_.push_back({method, std::make_unique<Series>(folder_, format, kept)});
  };
  if (output.skin_lbs) begin(linear_blend_skinned, "skin_lbs");
  if (output.skin_dqs) begin(dual_quaternion_skinned, "skin_dqs");
}

void FrameWriter::begin_export(std::size_t kept, SurfaceLook look) {
  look_ = std::move(look);
  for (std::string& library : look_.libraries) library = path_in(folder_, library);
  write_obj(folder_ / "surface.obj", surface_, look_);
  export_ = std::make_unique<PointCache>(folder_ / "surface.pc2", skin_.rest.size(), kept);
}

void FrameWriter::begin_arrays(const OutputSettings& output, SharedNeighbors near,
                               std::span<const double> kept, StrainInFrames strain) {
  const std::string words = strain == StrainInFrames::by_default ? words_for_arrays(output, body_)
                                                                 : words_asked_for(output, body_);
  arrays_ = requested_arrays(words);
  if (arrays_.empty() && !output.bonds && !probe_table_) return;
  measured_.emplace(body_, surface_, std::move(near));
  if (output.bonds)
    bond_series_.emplace(folder_, format_of(output, "bonds", body_.material.pair.r),
                         each(every_, kept));
  try {
    arrays_ = defined_arrays(measured_->rest(), measured_->at_rest(), words);
  } catch (const Error& error) {
    throw error.with_context({"output.arrays"});
  }
}

FrameWriter::FrameWriter(const std::filesystem::path& folder, const OutputSettings& output,
                         const Prepared& prepared)
    : FrameWriter(folder, output, prepared.body,
                  {prepared.surface.triangles, prepared.obstacles, prepared.look, prepared.probes,
                   prepared.body.neighbors}) {}

void FrameWriter::add(Simulation& simulation, double time, bool begun) {
  writer_.hand([&] {  // there is no other frame now: each takes as much memory as stepping does
    const auto frame = std::make_shared<Moved>(take(simulation, time));
    frame->begun = begun;
    return [this, frame] { write(*frame); };
  });
}

FrameWriter::Moved FrameWriter::take(Simulation& simulation, double time) {
  Moved frame = std::exchange(spare_, {});
  simulation.reuse(std::move(frame.particles), std::move(frame.forces));
  frame.moment = {time, static_cast<std::int32_t>(simulation.steps())};
  frame.with_particles = taken_++ % every_ == 0;
  frame.pose = simulation.pose();
  frame.energies = simulation.energies();
  if (body_.world) {
    WorldNow now = world_at(*body_.world, time, frame.pose);
    frame.obstacles = std::move(now.obstacles);
    frame.on_obstacles = simulation.reactions_of_obstacles();
    frame.supports = std::move(now.supports);
    frame.support_reactions = simulation.support_reactions();
    frame.load_reactions = simulation.load_reactions();
  }
  if (frame.with_particles) frame.broken_bonds = simulation.broken_bonds();
  frame.grouping = simulation.body().grouping;
  frame.reactions = simulation.reactions_of_bones();
  frame.forces = simulation.take_forces();
  frame.particles = simulation.take_particles();
  find_positions_by_id(frame.particles, frame.positions);
  frame.measured = FrameState();
  if (measured_ && (frame.with_particles || probe_table_)) {
    frame.measured.positions = frame.positions;
    for (const BonePose& bone : frame.pose) frame.measured.bones.push_back(bone.frame);
    measured_->take_forces(simulation, time, frame.measured);
  }
  for (const auto axis : {&Particles::x, &Particles::y, &Particles::z})
    frame.particles.*axis = std::vector<double>();  // {} would keep their memory
  return frame;
}

void FrameWriter::write(Moved& frame) {
  if (support_table_) write_supports(frame);
  const FrameState& state = frame.measured;
  if (probe_table_) write_probes(frame, state);
  if (frame.with_particles) write_particles(frame, state);
  write_surfaces(frame);
  bones_.add(bones_dataset(body_.skeleton, frame.pose, frame.moment));
  const std::vector<Reaction> sums = frame.reactions.sums();
  const ReactionColumns reactions(sums);
  frames_.add(frames_dataset(body_.skeleton, frame.pose, reactions, frame.moment));
  const auto springs = rows_of(frame.reactions.springs), pins = rows_of(frame.reactions.pins),
             obstacles = rows_of(frame.reactions.obstacles);
  bone_table_.add(frame.moment.time, body_.skeleton, rows_of(sums), {springs, pins, obstacles});
  if (obstacle_series_)
    obstacle_series_->add(
        obstacles_of(obstacles_, frame.obstacles, frame.on_obstacles, frame.moment));
  list_new_frames();
  ++written_;
  spare_ = std::move(frame);
}

void FrameWriter::write_supports(const Moved& frame) {
  const MachineMoment now = {frame.moment.time, frame.positions, frame.supports,
                             frame.support_reactions, frame.load_reactions};
  const std::vector<SupportFrame> frames = support_frames(*body_.world, now, body_.rest);
  support_table_->add(now, frames);
  support_series_->add(supports_dataset(frames, frame.moment));
}

void FrameWriter::write_probes(const Moved& frame, const FrameState& state) {
  static constexpr std::array<std::string_view, 2> tensors = {"strain", "stress"};
  const std::vector<Column> found = particle_arrays(measured_->rest(), state, tensors);
  const Points& world = frame.forces.world;
  Points force(world.size());
  for (std::size_t i = 0; i < world.size(); ++i)
    force[static_cast<std::size_t>(frame.particles.id[i])] = world[i];
  probe_table_->add(frame.moment.time, frame.positions, body_.rest,
                    {std::get<std::vector<double>>(found[0].values),
                     std::get<std::vector<double>>(found[1].values), force});
}

void FrameWriter::write_particles(Moved& frame, const FrameState& state) {
  std::vector<Column> requested;
  if (measured_) {
    requested = particle_arrays(measured_->rest(), state, arrays_);
    if (bond_series_)
      bond_series_->add(bonds_dataset(bond_values(measured_->rest(), state), frame.positions,
                                      selection_.ids, frame.moment));
  }
  const Forces& forces = frame.forces;
  std::vector<std::int32_t> group, level;
  if (frame.grouping) group = frame.grouping->group, level = frame.grouping->levels();
  const bool all = selection_.ids.empty();
  Dataset particles = particles_dataset({frame.particles,
                                         body_.rest,
                                         body_.binding,
                                         forces.pair,
                                         forces.damping,
                                         forces.bone,
                                         forces.neighbors,
                                         frame.energies,
                                         forces.world,
                                         body_.material_number,
                                         frame.broken_bonds,
                                         {},
                                         group,
                                         level,
                                         forces.group},
                                        all ? std::move(frame.positions) : frame.positions,
                                        frame.moment, selection_);
  for (Column& array : requested)
    particles.point_columns.push_back(rows_of(std::move(array), selection_.ids));
  if (frame.begun)
    particles_.finish(particles);
  else
    particles_.add(particles);
  if (all) frame.positions = std::move(particles.points);
}

void FrameWriter::write_surfaces(const Moved& frame) {
  surface_.points = follow(skin_, frame.positions);
  skins_.add(surface_dataset(surface_, skin_.rest, surface_bone_, frame.moment));
  if (export_) export_->add(surface_.points);
  for (const Skinned& skinned : skinned_) {
    const Triangles moved{skinned.method(skin_.rest, vertex_weights_, body_.skeleton, frame.pose),
                          surface_.faces};
    skinned.series->add(surface_dataset(moved, skin_.rest, surface_bone_, frame.moment));
  }
}

void FrameWriter::close() {
  writer_.finish();
  spare_ = {};
  particles_.drop_begun();
  for (Series* series : all_series()) {
    series->close();
    if (written_ > 0) checksums_->add(series->name() + ".pvd");  // else it has no row, and is none
  }
  bone_table_.close();
  checksums_->add("bones.csv");
  if (support_table_) {
    support_table_->close();
    checksums_->add("supports.csv");
  }
  if (probe_table_) {
    probe_table_->close();
    checksums_->add("probes.csv");
  }
  if (!export_) return;
  export_->close();
  for (const char* name : {"surface.obj", "surface.pc2"}) checksums_->add(name);
  if (written_ == 0) return;  // nothing moves
  std::vector<double> times;
  for (const PvdRow& row : skins_.rows()) times.push_back(row.time);
  write_moving_surface(folder_ / "surface.glb", surface_.faces, folder_ / "surface.pc2", times,
                       look_);
  checksums_->add("surface.glb");
}

}  // namespace sinew
