// SPDX-License-Identifier: GPL-3.0-or-later
#include "recorder.h"

#include <algorithm>

#include "core/closest_packing.h"
#include "io/frames.h"

namespace sinew {
namespace {

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
    bones.push_back(particle_bone[skin.particle[most - skin.weight.begin()]]);
  }
  return bones;
}

Dataset frames_of_bones(const Simulation& simulation, const Pose& pose, Moment moment) {
  const Skeleton& skeleton = simulation.body().skeleton;
  Points force, moment_of_force;
  for (const Reaction& on : reactions(simulation.particles(), simulation.body(), pose)) {
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
                   const Body& body, const Triangles& surface)
    : shape_(rest_shape(body.rest, rest_neighbour_range(body.material.pair.r))),
      skin_(make_skin(surface.points, shape_, body.material.pair.r)),
      surface_(surface),
      particle_bone_(bones_of_particles(body)),
      surface_bone_(bones_of_vertices(skin_, particle_bone_)),
      particles_(folder, format_of(output, "particles", body.material.pair.r)),
      skins_(folder, format_of(output, "surface", body.material.pair.r)),
      bones_(folder, format_of(output, "bones", body.material.pair.r)),
      frames_(folder, format_of(output, "frames", body.material.pair.r)) {}

Points Recorder::surface_now(const Particles& particles) const {
  Points now(particles.size());
  for (std::size_t i = 0; i < now.size(); ++i) now[particles.id[i]] = particles.position(i);
  return follow(skin_, shape_, now);
}

void Recorder::add(Simulation& simulation, double time) {
  const Moment moment{time, static_cast<std::int32_t>(simulation.steps())};
  const Particles& particles = simulation.particles();
  const Forces& forces = simulation.forces();
  Points total(particles.size());
  for (std::size_t i = 0; i < total.size(); ++i) total[i] = forces.total(i);
  particles_.add(
      particles_dataset({particles, shape_.points, particle_bone_, total, forces.pair,
                         forces.damping, forces.bone, forces.neighbours, simulation.energies()},
                        moment));
  surface_.points = surface_now(particles);
  skins_.add(surface_dataset(surface_, skin_.rest, surface_bone_, moment));
  const Pose pose = simulation.pose();
  bones_.add(bones_dataset(simulation.body().skeleton, pose, moment));
  frames_.add(frames_of_bones(simulation, pose, moment));
}

void Recorder::close() {
  for (Series* series : {&particles_, &skins_, &bones_, &frames_}) series->close();
}

}  // namespace sinew
