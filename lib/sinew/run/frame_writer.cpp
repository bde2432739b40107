// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/frame_writer.h>

#include <algorithm>

#include <sinew/core/arrays.h>
#include <sinew/core/parallel.h>
#include <sinew/io/gltf/moving_surface.h>
#include <sinew/metrics/particle_values.h>
#include <sinew/run/run_files.h>

namespace sinew {
namespace {

constexpr std::size_t values_per_piece = 1 << 14;

VtuFormat format_of(const OutputSettings& output, const char* series, double radius) {
  return {output.encoding, output.double_precision, series, radius};
}

/// The bone of the particle that moves each vertex most.
std::vector<std::int32_t> bones_of_vertices(const Skin& skin,
                                            const std::vector<std::int32_t>& particle_bone) {
  std::vector<std::int32_t> bones;
  for (std::size_t i = 0; i < skin.rest.size(); ++i) {
    const auto begin = skin.weight.begin() + skin.first[i];
    const auto most = std::max_element(begin, skin.weight.begin() + skin.first[i + 1]);
    bones.push_back(particle_bone[skin.near[skin.particle[most - skin.weight.begin()]]]);
  }
  return bones;
}

/// Copies into memory that is already allocated.
template <class T>
void copy(const std::vector<T>& from, std::vector<T>& to) {
  to.resize(from.size());
  parallel_for(from.size(), values_per_piece, [&](std::size_t begin, std::size_t end) {
    std::copy(from.begin() + begin, from.begin() + end, to.begin() + begin);
  });
}

void copy(const Particles& from, Particles& to) {
  to.radius = from.radius;
  to.mass = from.mass;
  for (const auto axis :
       {&Particles::x, &Particles::y, &Particles::z, &Particles::u, &Particles::v, &Particles::w})
    copy(from.*axis, to.*axis);
  copy(from.id, to.id);
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

std::vector<double> powers_of(const std::vector<Reaction>& reactions) {
  std::vector<double> powers;
  powers.reserve(reactions.size());
  for (const Reaction& on : reactions) powers.push_back(on.power);
  return powers;
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
                         const Body& body, const Triangles& surface,
                         std::vector<Triangles> obstacles, std::span<const double> kept)
    : folder_(folder),
      interval_(output.interval),
      skeleton_(body.skeleton),
      rest_(body.rest),
      skin_(make_skin(surface.points, rest_, body.material.pair.r, body.skeleton, body.binding)),
      surface_(surface),
      particle_bone_(bones_of_particles(body)),
      surface_bone_(bones_of_vertices(skin_, particle_bone_)),
      obstacles_(std::move(obstacles)),
      particle_weight_(weights_of_particles(body)),
      particles_(folder, format_of(output, "particles", body.material.pair.r), kept),
      skins_(folder, format_of(output, "surface", body.material.pair.r), kept),
      bones_(folder, format_of(output, "bones", body.material.pair.r), kept),
      frames_(folder, format_of(output, "frames", body.material.pair.r), kept),
      bone_table_(folder / "bones.csv", body.skeleton.size(), kept.size()),
      written_(static_cast<int>(kept.size())),
      writer_(moved_.size()) {
  if (!obstacles_.empty())
    obstacle_series_.emplace(folder, format_of(output, "obstacles", body.material.pair.r), kept);
  begin_skinned(folder, output, body, kept);
  if (output.export_surface) begin_export(folder, kept.size());
  begin_arrays(output, body);
}

void FrameWriter::begin_skinned(const std::filesystem::path& folder, const OutputSettings& output,
                                const Body& body, std::span<const double> kept) {
  if (output.skin_lbs || output.skin_dqs) vertex_weights_ = weights_of_vertices(body, skin_.rest);
  const auto begin = [&](auto* method, const char* name) {
    skinned_.push_back({method, std::make_unique<Series>(
                                    folder, format_of(output, name, body.material.pair.r), kept)});
  };
  if (output.skin_lbs) begin(linear_blend_skinned, "skin_lbs");
  if (output.skin_dqs) begin(dual_quaternion_skinned, "skin_dqs");
}

void FrameWriter::begin_export(const std::filesystem::path& folder, std::size_t kept) {
  write_obj(folder / "surface.obj", surface_);
  export_ = std::make_unique<PointCache>(folder / "surface.pc2", skin_.rest.size(), kept);
}

void FrameWriter::begin_arrays(const OutputSettings& output, const Body& body) {
  arrays_ = requested_arrays(output.arrays);
  if (arrays_.empty()) return;
  RestInput input = measured_body(body.material, body.skeleton);
  input.positions = rest_;
  input.surface = surface_;
  input.bone.assign(particle_bone_.begin(), particle_bone_.end());
  measured_ = rest_body(std::move(input));
}

FrameWriter::FrameWriter(const std::filesystem::path& folder, const OutputSettings& output,
                         const ReadyScene& ready)
    : FrameWriter(folder, output, ready.setup.body, ready.surface.triangles,
                  ready.setup.obstacles) {}

void FrameWriter::add(Simulation& simulation, double time) {
  writer_.hand([&] {
    // The queue has space, so the previous frame of this slot is written: at most one job is
    // pending, the last one.
    Moved& frame = moved_[taken_ % moved_.size()];
    take(simulation, time, frame);
    ++taken_;
    return [this, &frame] { write(frame); };
  });
}

void FrameWriter::take(Simulation& simulation, double time, Moved& frame) {
  const Forces& forces = simulation.forces();
  frame.moment = {time, static_cast<std::int32_t>(simulation.steps())};
  copy(simulation.particles(), frame.particles);
  copy(forces.pair, frame.force_pair);
  copy(forces.damping, frame.force_damping);
  copy(forces.bone, frame.force_bone);
  copy(forces.world, frame.force_world);
  copy(forces.neighbors, frame.neighbors);
  const auto broken = simulation.broken_bonds();
  frame.broken_bonds.assign(broken.begin(), broken.end());
  frame.energies = simulation.energies();
  frame.pose = simulation.pose();
  frame.reactions = reactions(simulation.particles(), simulation.body(), frame.pose);
  if (!simulation.body().world) return;
  frame.obstacles = world_at(*simulation.body().world, time, frame.pose).obstacles;
  const auto on = simulation.reactions_of_obstacles();
  frame.on_obstacles.assign(on.begin(), on.end());
}

void FrameWriter::write(const Moved& frame) {
  Dataset particles =
      particles_dataset({frame.particles, rest_, particle_bone_, frame.force_pair,
                         frame.force_damping, frame.force_bone, frame.neighbors, frame.energies,
                         particle_weight_, frame.force_world, frame.broken_bonds},
                        frame.moment);
  add_arrays(frame, particles);
  particles_.add(particles);
  write_surfaces(frame, particles.points);
  bones_.add(bones_dataset(skeleton_, frame.pose, frame.moment));
  const ReactionColumns reactions(frame.reactions);
  frames_.add(frames_dataset(skeleton_, frame.pose, reactions, frame.moment));
  bone_table_.add(frame.moment.time, skeleton_, reactions, powers_of(frame.reactions));
  if (obstacle_series_)
    obstacle_series_->add(
        obstacles_of(obstacles_, frame.obstacles, frame.on_obstacles, frame.moment));
  ++written_;
}

void FrameWriter::add_arrays(const Moved& frame, Dataset& particles) const {
  if (!measured_) return;
  FrameState state;
  state.positions = particles.points;
  for (const BonePose& bone : frame.pose) state.bones.push_back(bone.frame);
  for (Column& array : particle_arrays(*measured_, state, arrays_))
    particles.point_columns.push_back(std::move(array));
}

void FrameWriter::write_surfaces(const Moved& frame, const Points& particles) {
  surface_.points = follow(skin_, particles);
  skins_.add(surface_dataset(surface_, skin_.rest, surface_bone_, frame.moment));
  if (export_) export_->add(surface_.points);
  for (const Skinned& skinned : skinned_) {
    const Triangles moved{skinned.method(skin_.rest, vertex_weights_, skeleton_, frame.pose),
                          surface_.faces};
    skinned.series->add(surface_dataset(moved, skin_.rest, surface_bone_, frame.moment));
  }
}

void FrameWriter::close() {
  writer_.finish();
  for (Series* series : {&particles_, &skins_, &bones_, &frames_}) series->close();
  if (obstacle_series_) obstacle_series_->close();
  for (const Skinned& skinned : skinned_) skinned.series->close();
  bone_table_.close();
  if (!export_) return;
  export_->close();
  write_moving_surface(folder_ / "surface.glb", surface_.faces, folder_ / "surface.pc2", interval_);
}

}  // namespace sinew
