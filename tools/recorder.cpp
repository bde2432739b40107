// SPDX-License-Identifier: GPL-3.0-or-later
#include "recorder.h"

#include <algorithm>

#include "core/parallel.h"

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

/// Copies into room that is there already.
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

Dataset frames_of_bones(const Skeleton& skeleton, const Pose& pose,
                        const std::vector<Reaction>& reactions, Moment moment) {
  Points force, moment_of_force;
  for (const Reaction& on : reactions) {
    force.push_back(on.force);
    moment_of_force.push_back(on.moment);
  }
  return frames_dataset(skeleton, pose, {force, moment_of_force}, moment);
}

}  // namespace

std::vector<std::int32_t> bones_of_particles(const Body& body) {
  std::vector<std::int32_t> bones(body.rest.size());
  for (std::size_t i = 0; i < bones.size(); ++i) bones[i] = body.binding.bone(i);
  return bones;
}

Recorder::Recorder(const std::filesystem::path& folder, const OutputSettings& output,
                   const Body& body, const Triangles& surface, std::span<const double> kept)
    : skeleton_(body.skeleton),
      rest_(body.rest),
      skin_(make_skin(surface.points, rest_, body.material.pair.r)),
      surface_(surface),
      particle_bone_(bones_of_particles(body)),
      surface_bone_(bones_of_vertices(skin_, particle_bone_)),
      particles_(folder, format_of(output, "particles", body.material.pair.r), kept),
      skins_(folder, format_of(output, "surface", body.material.pair.r), kept),
      bones_(folder, format_of(output, "bones", body.material.pair.r), kept),
      frames_(folder, format_of(output, "frames", body.material.pair.r), kept),
      written_(static_cast<int>(kept.size())),
      writer_(moved_.size()) {}

void Recorder::add(Simulation& simulation, double time) {
  writer_.hand([&] {
    // There is room, so the frame that was here before is written: one job at most is under way,
    // the last one.
    Moved& frame = moved_[taken_ % moved_.size()];
    take(simulation, time, frame);
    ++taken_;
    return [this, &frame] { write(frame); };
  });
}

void Recorder::take(Simulation& simulation, double time, Moved& frame) {
  const Forces& forces = simulation.forces();
  frame.moment = {time, static_cast<std::int32_t>(simulation.steps())};
  copy(simulation.particles(), frame.particles);
  copy(forces.pair, frame.force_pair);
  copy(forces.damping, frame.force_damping);
  copy(forces.bone, frame.force_bone);
  copy(forces.neighbours, frame.neighbours);
  frame.energies = simulation.energies();
  frame.pose = simulation.pose();
  frame.reactions = reactions(simulation.particles(), simulation.body(), frame.pose);
}

void Recorder::write(const Moved& frame) {
  const Dataset particles =
      particles_dataset({frame.particles, rest_, particle_bone_, frame.force_pair,
                         frame.force_damping, frame.force_bone, frame.neighbours, frame.energies},
                        frame.moment);
  particles_.add(particles);
  surface_.points = follow(skin_, particles.points);
  skins_.add(surface_dataset(surface_, skin_.rest, surface_bone_, frame.moment));
  bones_.add(bones_dataset(skeleton_, frame.pose, frame.moment));
  frames_.add(frames_of_bones(skeleton_, frame.pose, frame.reactions, frame.moment));
  ++written_;
}

void Recorder::close() {
  writer_.finish();
  for (Series* series : {&particles_, &skins_, &bones_, &frames_}) series->close();
}

}  // namespace sinew
