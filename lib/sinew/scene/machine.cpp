// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/machine.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include <sinew/core/text.h>
#include <sinew/scene/context.h>
#include <sinew/scene/world.h>

namespace sinew {

std::string path_of_one(const char* list, std::size_t index) {
  return std::string(list) + '[' + std::to_string(index) + ']';
}

namespace {

/// Throws bad input where the entries of a list so far are on more particles than any machine's:
/// each takes memory and time by its particles.
template <class Entry>
void refuse_too_many(const char* list, const std::vector<Entry>& entries, std::size_t particles) {
  constexpr std::size_t times_over = 64, smallest = 1000;
  std::size_t sum = 0;
  for (const Entry& entry : entries) sum += entry.particles.size();
  if (sum > times_over * std::max(particles, smallest))
    throw bad_input("the " + std::string(list) + " up to this one are on " + std::to_string(sum) +
                        " particles in sum, over " + std::to_string(times_over) +
                        " times as many as the body has",
                    "give those on the same part as one");
}

Vec3 mean_of(const std::vector<std::uint32_t>& particles, const Points& rest) {
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t i : particles) sum += rest[i];
  return sum / static_cast<double>(particles.size());
}

Support support_of(const SupportSettings& given, const std::string& path, const Body& body,
                   const ParticleParts& parts) {
  Support support;
  support.name = given.name;
  support.particles = parts.particles(given.part, path);
  const int bits = static_cast<int>(given.hold) + 1;
  for (std::size_t axis = 0; axis < 3; ++axis) support.holds[axis] = ((bits >> axis) & 1) != 0;
  if (given.hold_along) support.along = given.hold_along->normalized();
  support.pivot = given.pivot ? *given.pivot : mean_of(support.particles, body.rest);
  if (!given.keys.empty())
    support.motion = keyed_motion(given.name, given.interpolation, given.keys, support.pivot);
  return support;
}

/// A force distributed over all particles of a part.
Load by_mass(const LoadSettings& given, const std::string& path, const Body& body,
             const ParticleParts& parts) {
  const std::vector<std::uint32_t> on = parts.particles(given.part, path);
  std::vector<double> weights;
  double mass = 0;
  for (const std::uint32_t i : on) {
    weights.push_back(mass_of(body, i, 1));
    mass += body.material.mass * weights.back();
  }
  const Vec3 force = given.gravity ? Vec3(mass * *given.gravity) : *given.force;
  return force_load(given.name, on, weights, force, body.rest);
}

/// A force, a traction or a pressure on the faces of a part.
Load by_area(const LoadSettings& given, const std::string& path, const Body& body,
             const ParticleParts& parts) {
  const double radius = body.material.pair.r;
  if (given.pressure)
    return pressure_load(given.name, parts.pressed_faces(given.part, path), *given.pressure,
                         body.rest, radius);
  const Triangles faces = parts.faces(given.part, path);
  const AreaWeights area = area_weights(faces, body.rest, radius);
  const Vec3 force = given.traction ? Vec3(area.area * *given.traction) : *given.force;
  return force_load(given.name, area.particles, area.weights, force, body.rest);
}

Load load_of(const LoadSettings& given, const std::string& path, const Body& body,
             const ParticleParts& parts) {
  const bool on_surface = given.pressure || given.traction || (given.force && given.part.faces());
  Load load = on_surface ? by_area(given, path, body, parts) : by_mass(given, path, body, parts);
  if (given.pivot) load.pivot = *given.pivot;
  for (const ValueKeySettings& key : given.keys) {
    load.scale.times.push_back(key.time);
    load.scale.values.push_back(key.value);
  }
  return load;
}

/// Throws bad input for a point that is outside of all particles: `key` of entry `path`.
void refuse_far(const Vec3& at, const std::string& what, const std::string& key, const Body& body,
                const Settings& settings) {
  constexpr double farthest = 4;  // radii: corners of coarse bodies are outside of all particles
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vec3& place : body.rest) nearest = std::min(nearest, (place - at).norm());
  if (nearest > farthest * body.material.pair.r)
    throw bad_input(settings.place(key),
                    what + " is " + three_digits(nearest) + " m away from the nearest particle",
                    "give a point of the body at rest, " + extent_text(body.rest));
}

Load spring_of(const Settings& settings, std::size_t index, const Body& body) {
  const SpringSettings& given = settings.world.springs[index];
  const std::string path = path_of_one("world.springs", index),
                    what = "spring '" + given.name + '\'';
  const std::size_t count = body.rest.size();
  if (given.particle && static_cast<std::size_t>(*given.particle) >= count)
    throw bad_input(settings.place(path + ".particle"),
                    "there is no particle " + std::to_string(*given.particle),
                    "give an id from 0 to " + std::to_string(count - 1));
  if (given.at) refuse_far(*given.at, what, path + ".at", body, settings);
  Load load = given.at ? spring_load(given.name, *given.at, given.stiffness, body.rest,
                                     body.material.pair.r)
                       : spring_load(given.name, static_cast<std::uint32_t>(*given.particle),
                                     given.stiffness, body.rest);
  for (const SpringKeySettings& key : given.keys) {
    load.scale.times.push_back(key.time), load.scale.values.push_back(key.factor);
    load.free_end.times.push_back(key.time), load.free_end.places.push_back(key.to);
  }
  return load;
}

Probe point_probe(const Settings& settings, std::size_t index, const Body& body) {
  const ProbeSettings& given = settings.probes[index];
  refuse_far(*given.at, "probe '" + given.name + '\'', path_of_one("probes", index) + ".at", body,
             settings);
  FollowingPoints point = following({*given.at}, body.rest, body.material.pair.r);
  return {given.name, std::move(point.particle), std::move(point.weight), true};
}

Probe part_probe(const std::string& name, std::vector<std::uint32_t> particles) {
  const double weight = 1 / static_cast<double>(particles.size());
  const std::size_t count = particles.size();
  return {name, std::move(particles), std::vector<double>(count, weight), false};
}

}  // namespace

void add_machine(const Settings& settings, const Body& body, const ParticleParts& parts,
                 World& world) {
  for (std::size_t k = 0; k < settings.supports.size(); ++k)
    world.supports.push_back(
        support_of(settings.supports[k], path_of_one("supports", k), body, parts));
  at_keys(settings, "", [&] { hold(world, body.rest.size()); });
  for (std::size_t k = 0; k < settings.loads.size(); ++k) {
    const std::string path = path_of_one("loads", k);
    with_context(settings, path.c_str(), [&] {
      world.loads.push_back(load_of(settings.loads[k], path, body, parts));
      refuse_too_many("loads", world.loads, body.rest.size());
    });
  }
  for (std::size_t k = 0; k < settings.world.springs.size(); ++k)
    world.loads.push_back(spring_of(settings, k, body));
}

std::vector<Probe> probes_of(const Settings& settings, const Body& body,
                             const ParticleParts& parts) {
  std::vector<Probe> probes;
  for (std::size_t k = 0; k < settings.probes.size(); ++k) {
    const ProbeSettings& given = settings.probes[k];
    const std::string path = path_of_one("probes", k);
    probes.push_back(given.at ? point_probe(settings, k, body)
                              : part_probe(given.name, parts.particles(given.part, path)));
    with_context(settings, path.c_str(),
                 [&] { refuse_too_many("probes", probes, body.rest.size()); });
  }
  return probes;
}

}  // namespace sinew
