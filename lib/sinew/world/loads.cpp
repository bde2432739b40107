// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/loads.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/simulation_state.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

std::string name_of(const std::string& load) { return "load '" + load + '\''; }

Vec3 area_of(const std::array<int, 3>& face, const Points& points) {
  const Vec3& a = points[static_cast<std::size_t>(face[0])];
  return (points[static_cast<std::size_t>(face[1])] - a)
             .cross(points[static_cast<std::size_t>(face[2])] - a) /
         2;
}

/// A third of the area of the faces around each point, m^2.
std::vector<double> areas_of_points(const Triangles& surface) {
  std::vector<double> areas(surface.points.size(), 0);
  for (const auto& face : surface.faces)
    for (const int corner : face)
      areas[static_cast<std::size_t>(corner)] += area_of(face, surface.points).norm() / 3;
  return areas;
}

AreaWeights area_weights(const Triangles& surface, const FollowingPoints& points) {
  const std::vector<double> areas = areas_of_points(surface);
  AreaWeights all;
  for (std::size_t k = 0; k < points.size(); ++k) {
    all.area += areas[k];
    for (std::uint32_t e = points.first[k]; e < points.first[k + 1]; ++e) {
      all.particles.push_back(points.particle[e]);
      all.weights.push_back(areas[k] * points.weight[e]);
    }
  }
  return all;
}

}  // namespace

Load force_load(const std::string& name, const std::vector<std::uint32_t>& particles,
                const std::vector<double>& weights, const Vec3& force, const Points& rest) {
  std::map<std::uint32_t, double> summed;
  double sum = 0;
  for (std::size_t k = 0; k < particles.size(); ++k) {
    summed[particles[k]] += weights[k];
    sum += weights[k];
  }
  if (!(std::abs(sum) > 0))
    throw bad_input(name_of(name) + " acts on nothing", "place its region on the body at rest");
  Load load;
  load.name = name;
  load.force = force;
  for (const auto& [particle, weight] : summed) {
    load.particles.push_back(particle);
    load.weight.push_back(weight / sum);
    load.pivot += weight / sum * rest[particle];
  }
  return load;
}

AreaWeights area_weights(const Triangles& surface, const Points& rest, double radius) {
  return area_weights(surface, following(surface.points, rest, radius));
}

Load pressure_load(const std::string& name, const Triangles& surface, double pressure,
                   const Points& rest, double radius) {
  FollowingPoints corners = following(surface.points, rest, radius, followed_by_corners);
  const AreaWeights area = area_weights(surface, corners);
  Load load = force_load(name, area.particles, area.weights, Vec3::Zero(), rest);
  load.pressure = pressure;
  load.faces = surface.faces;
  load.corners = std::move(corners);
  for (std::uint32_t& particle : load.corners.particle)
    particle = static_cast<std::uint32_t>(
        std::lower_bound(load.particles.begin(), load.particles.end(), particle) -
        load.particles.begin());
  return load;
}

Load spring_load(const std::string& name, const Vec3& point, double stiffness, const Points& rest,
                 double radius) {
  const FollowingPoints at = following({point}, rest, radius);
  Load load = force_load(name, at.particle, at.weight, Vec3::Zero(), rest);
  load.stiffness = stiffness;
  return load;
}

Load spring_load(const std::string& name, std::uint32_t particle, double stiffness,
                 const Points& rest) {
  Load load = force_load(name, {particle}, {1}, Vec3::Zero(), rest);
  load.stiffness = stiffness;
  return load;
}

void save_loads(std::span<const LoadNow> loads, SimulationState& state) {
  // Steps of each pressure, places of its corners, m, and their motions in a step, m.
  std::vector<double> numbers;
  for (const LoadNow& load : loads) load.pressed().save(numbers);
  put_column(state, "pressures", "numbers", std::move(numbers));
}

void restore_loads(const SimulationState& state, std::span<LoadNow> loads) {
  std::size_t expected = 0, next = 0;
  for (const LoadNow& load : loads) expected += load.pressed().saved_size();
  const std::vector<double> saved = column_of<double>(state, "pressures", "numbers");
  if (saved.empty()) {  // where no step has been made
    for (LoadNow& load : loads) load.pressed().forget();
    return;
  }
  bool fits = saved.size() == expected && all_finite(saved);
  for (LoadNow& load : loads) {
    fits = fits && load.pressed().restore(saved.data() + next);
    next += load.pressed().saved_size();
  }
  if (!fits) throw not_a_state("it has other pressures");
}

double load_stiffness(const Load& load, double radius) {
  // A corner's force changes by at most p / 2 times the opposite sides of its faces, about six of
  // two radii, when it moves, and as much when its neighbors do; weights may alternate.
  constexpr double sides = 24;
  double of_spring = 0;  // norm of k w w^T, N/m
  for (const double weight : load.weight) of_spring += load.stiffness * weight * weight;
  return (sides * std::abs(load.pressure) * radius + of_spring) * load.scale.largest();
}

void check_load(const Load& load) {
  const bool is_finite =
      load.force.allFinite() && std::isfinite(load.pressure) && std::isfinite(load.stiffness);
  if (!is_finite) throw bad_input(name_of(load.name) + " is not finite", "give finite numbers");
  constexpr double any = std::numeric_limits<double>::max();
  check_keys(load.scale, -any, any, name_of(load.name));
}

}  // namespace sinew
