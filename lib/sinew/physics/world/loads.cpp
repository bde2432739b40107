// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/world/loads.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/parallel.h>
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

AreaShares area_shares(const Triangles& surface, const FollowingPoints& points) {
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
  return area_shares(surface, following(surface.points, rest, radius));
}

Load pressure_load(const std::string& name, const Triangles& surface, double pressure,
                   const Points& rest, double radius) {
  FollowingPoints corners = following(surface.points, rest, radius, followed_by_corners);
  const AreaShares area = area_shares(surface, corners);
  Load load = force_load(name, area.particles, area.shares, Vec3::Zero(), rest);
  load.pressure = pressure;
  load.faces = surface.faces;
  load.corners = std::move(corners);
  for (std::uint32_t& particle : load.corners.particle)
    particle = static_cast<std::uint32_t>(
        std::lower_bound(load.particles.begin(), load.particles.end(), particle) -
        load.particles.begin());
  return load;
}

LoadNow::LoadNow(const Load& load) : forces_(load.particles.size(), Four::Zero()) {
  if (load.faces.empty()) return;
  at_.assign(load.particles.size(), Four::Zero());
  corner_.resize(load.corners.size());
  pushed_.resize(load.corners.size());
  area_.resize(load.faces.size());
  order_corners(load);
  const auto transposed = [](const Weights& from, std::size_t rows, Weights& to) {
    std::vector<std::uint32_t> row_of(from.source.size()), entries;
    for (std::uint32_t k = 0; k + 1 < from.first.size(); ++k)
      for (std::uint32_t e = from.first[k]; e < from.first[k + 1]; ++e) row_of[e] = k;
    const auto for_each = [&](const auto& visit) {
      for (std::uint32_t e = 0; e < from.source.size(); ++e) visit(e, from.source[e]);
    };
    transpose(rows, for_each, to.first, entries);
    for (const std::uint32_t entry : entries) {
      to.source.push_back(row_of[entry]);
      to.weight.push_back(from.weight[entry]);
    }
  };
  transposed(of_corners_, load.particles.size(), of_particles_);
  const auto for_each_corner = [&](const auto& visit) {
    for (std::uint32_t f = 0; f < face_.size(); ++f)
      for (const std::uint32_t corner : face_[f]) visit(f, corner);
  };
  transpose(corner_.size(), for_each_corner, of_faces_.first, of_faces_.source);
}

/// Corners and faces are taken in the order of the particles that they follow: so neighbors lie
/// near each other in memory, whatever the order of the mesh.
void LoadNow::order_corners(const Load& load) {
  const FollowingPoints& given = load.corners;
  const auto sorted = [](std::size_t count, const auto& key) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    return order;
  };
  const auto corners =
      sorted(given.size(), [&](std::uint32_t k) { return given.particle[given.first[k]]; });
  std::vector<std::uint32_t> place(given.size());
  of_corners_.first = {0};
  for (std::uint32_t n = 0; n < corners.size(); ++n) {
    place[corners[n]] = n;
    for (std::uint32_t e = given.first[corners[n]]; e < given.first[corners[n] + 1]; ++e) {
      of_corners_.source.push_back(given.particle[e]);
      of_corners_.weight.push_back(given.weight[e]);
    }
    of_corners_.first.push_back(static_cast<std::uint32_t>(of_corners_.source.size()));
  }
  const auto corner = [&](std::uint32_t f, std::size_t n) {
    return place[static_cast<std::size_t>(load.faces[f][n])];
  };
  for (const std::uint32_t f :
       sorted(load.faces.size(), [&](std::uint32_t face) { return corner(face, 0); }))
    face_.push_back({corner(f, 0), corner(f, 1), corner(f, 2)});
}

void LoadNow::find_forces(const Load& load, double scale) {
  if (!load.faces.empty()) find_pressure(load, scale);
  if (!load.faces.empty() && load.force.isZero(0)) return;
  parallel_for(forces_.size(), particles_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (load.faces.empty()) forces_[k].setZero();
      forces_[k].head<3>() += scale * load.share[k] * load.force;
    }
  });
}

void LoadNow::find_pressure(const Load& load, double scale) {
  const auto on_all = [](std::size_t count, const auto& each) {
    parallel_for(count, particles_per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) each(k);
    });
  };
  on_all(corner_.size(), [&](std::size_t k) { corner_[k] = of_corners_.sum(k, at_); });
  const double part = -scale * load.pressure / 6;  // of three corners; twice the area
  on_all(face_.size(), [&](std::size_t f) {
    const Vec3 a = corner_[face_[f][0]].head<3>(), b = corner_[face_[f][1]].head<3>(),
               c = corner_[face_[f][2]].head<3>();
    area_[f] << part * (b - a).cross(c - a), 0;
  });
  on_all(pushed_.size(), [&](std::size_t k) {
    Four sum = Four::Zero();
    for (std::uint32_t e = of_faces_.first[k]; e < of_faces_.first[k + 1]; ++e)
      sum += area_[of_faces_.source[e]];
    pushed_[k] = sum;
  });
  on_all(forces_.size(), [&](std::size_t k) { forces_[k] = of_particles_.sum(k, pushed_); });
}

double LoadNow::size(const Load& load, double scale) const {
  return std::abs(scale) * load.force.norm() +
         parallel_sum(pushed_.size(), particles_per_task, [&](std::size_t begin, std::size_t end) {
           double sum = 0;
           for (std::size_t k = begin; k < end; ++k) sum += pushed_[k].norm();
           return sum;
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
