// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/world/loads.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <sinew/core/error.h>
#include <sinew/core/parallel.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_task = 256;

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

/// The transposed lists: of each target, the sources that name it, in their order.
template <class Visit>
void transpose(std::size_t targets, const Visit& for_each, std::vector<std::uint32_t>& first,
               std::vector<std::uint32_t>& source) {
  first.assign(targets + 1, 0);
  for_each([&](std::uint32_t, std::uint32_t target) { ++first[target + 1]; });
  for (std::size_t k = 0; k < targets; ++k) first[k + 1] += first[k];
  source.resize(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for_each([&](std::uint32_t from, std::uint32_t target) { source[next[target]++] = from; });
}

}  // namespace

Load force_load(const std::string& name, const std::vector<std::uint32_t>& particles,
                const std::vector<double>& shares, const Vec3& force, const Points& rest) {
  std::map<std::uint32_t, double> summed;
  double sum = 0;
  for (std::size_t k = 0; k < particles.size(); ++k) {
    summed[particles[k]] += shares[k];
    sum += shares[k];
  }
  if (!(std::abs(sum) > 0))
    throw bad_input(name_of(name) + " acts on nothing", "place its region on the body at rest");
  Load load;
  load.name = name;
  load.force = force;
  for (const auto& [particle, share] : summed) {
    load.particles.push_back(particle);
    load.share.push_back(share / sum);
    load.pivot += share / sum * rest[particle];
  }
  return load;
}

AreaShares area_shares(const Triangles& surface, const Points& rest, double radius) {
  const FollowingPoints points = following(surface.points, rest, radius);
  const std::vector<double> areas = areas_of_points(surface);
  AreaShares all;
  for (std::size_t k = 0; k < points.size(); ++k) {
    all.area += areas[k];
    for (std::uint32_t e = points.first[k]; e < points.first[k + 1]; ++e) {
      all.particles.push_back(points.particle[e]);
      all.shares.push_back(areas[k] * points.weight[e]);
    }
  }
  return all;
}

Load pressure_load(const std::string& name, const Triangles& surface, double pressure,
                   const Points& rest, double radius) {
  const AreaShares area = area_shares(surface, rest, radius);
  Load load = force_load(name, area.particles, area.shares, Vec3::Zero(), rest);
  load.pressure = pressure;
  load.faces = surface.faces;
  load.corners = following(surface.points, rest, radius);
  for (std::uint32_t& particle : load.corners.particle)
    particle = static_cast<std::uint32_t>(
        std::lower_bound(load.particles.begin(), load.particles.end(), particle) -
        load.particles.begin());
  return load;
}

LoadNow::LoadNow(const Load& load) : forces(load.particles.size(), Vec3::Zero()) {
  if (load.faces.empty()) return;
  const FollowingPoints& corners = load.corners;
  std::vector<std::uint32_t> entries;
  const auto for_each_weight = [&](const auto& visit) {
    for (std::uint32_t e = 0; e < corners.particle.size(); ++e) visit(e, corners.particle[e]);
  };
  transpose(load.particles.size(), for_each_weight, first_, entries);
  std::vector<std::uint32_t> corner_of(corners.particle.size());
  for (std::uint32_t k = 0; k < corners.size(); ++k)
    for (std::uint32_t e = corners.first[k]; e < corners.first[k + 1]; ++e) corner_of[e] = k;
  for (const std::uint32_t entry : entries) {
    corner_.push_back(corner_of[entry]);
    weight_.push_back(corners.weight[entry]);
  }
  const auto for_each_corner = [&](const auto& visit) {
    for (std::uint32_t f = 0; f < load.faces.size(); ++f)
      for (const int corner : load.faces[f]) visit(f, static_cast<std::uint32_t>(corner));
  };
  transpose(corners.size(), for_each_corner, first_face_, face_);
}

void LoadNow::find(const Load& load, double scale,
                   const std::function<Vec3(std::uint32_t)>& position) {
  const auto on_all = [](std::size_t count, const auto& each) {
    parallel_for(count, particles_per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) each(k);
    });
  };
  on_all(forces.size(), [&](std::size_t k) { forces[k] = scale * load.share[k] * load.force; });
  if (load.faces.empty()) return;
  Points at(load.particles.size());
  on_all(at.size(), [&](std::size_t k) { at[k] = position(load.particles[k]); });
  const Points corners = load.corners.at(at);
  Points pushed(corners.size());
  on_all(pushed.size(), [&](std::size_t k) {
    Vec3 area = Vec3::Zero();
    for (std::uint32_t e = first_face_[k]; e < first_face_[k + 1]; ++e)
      area += area_of(load.faces[face_[e]], corners);
    pushed[k] = -scale * load.pressure / 3 * area;
  });
  on_all(forces.size(), [&](std::size_t k) {
    for (std::uint32_t e = first_[k]; e < first_[k + 1]; ++e)
      forces[k] += weight_[e] * pushed[corner_[e]];
  });
}

double load_stiffness(const Load& load, double radius) {
  // A corner's force changes by at most p / 2 times the opposite sides of its faces, about six of
  // two radii, when it moves, and as much when its neighbors do; weights may alternate.
  constexpr double sides = 24;
  return sides * std::abs(load.pressure) * load.scale.largest() * radius;
}

void check_load(const Load& load) {
  if (!load.force.allFinite() || !std::isfinite(load.pressure))
    throw bad_input(name_of(load.name) + " is not finite", "give finite numbers");
  constexpr double any = std::numeric_limits<double>::max();
  check_keys(load.scale, -any, any, name_of(load.name));
}

}  // namespace sinew
