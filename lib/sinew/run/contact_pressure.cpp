// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/contact_pressure.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <sinew/core/cell_grid.h>
#include <sinew/core/parallel.h>
#include <sinew/core/rest_neighbors.h>
#include <sinew/core/union_find.h>
#include <sinew/material/laws.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

constexpr std::size_t particles_pressed_at_a_time = 1024, faces_at_a_time = 64;
constexpr double part_size = 1.0 / 3;  // radii: an area is then within some 2 %
constexpr double min_facing = 0.5;     // cosine between a face and what presses on it
constexpr double owned_range = 3;      // radii: farther from all particles, a surface is nobody's

/// The area along the outward normal.
Vec3 area_of(const Points& points, const std::array<int, 3>& face) {
  const Vec3& a = points[face[0]];
  return (points[face[1]] - a).cross(points[face[2]] - a) / 2;
}

std::vector<std::int32_t> bodies_of(const Points& rest, double radius) {
  const NeighborLists near = neighbors_within(rest, rest_neighbor_range(radius));
  UnionFind sets(rest.size());
  for (std::uint32_t i = 0; i < rest.size(); ++i)
    for (const std::uint32_t j : near.of(i)) sets.join(static_cast<int>(i), static_cast<int>(j));
  std::vector<std::int32_t> body(rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i) body[i] = sets.first_of(static_cast<int>(i));
  return body;
}

/// Calls visit(weights of the corners) at the centers of equal parts of a face with sides up to
/// `longest`.
template <class Visit>
void for_each_part(const Points& points, const std::array<int, 3>& face, double longest,
                   const Visit& visit) {
  double side = 0;
  for (int k = 0; k < 3; ++k)
    side = std::max(side, (points[face[k]] - points[face[(k + 1) % 3]]).norm());
  const int n = std::max(1, static_cast<int>(std::ceil(side / longest)));
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j)
      for (const double center : {1.0 / 3, 2.0 / 3}) {
        const double u = (i + center) / n, v = (j + center) / n;
        if (u + v < 1) visit(Vec3(1 - u - v, u, v), 1.0 / (n * n));
      }
}

}  // namespace

ContactPressure::ContactPressure(const Triangles& surface, const Body& body)
    : body_(body),
      faces_(surface.faces),
      owns_(body.rest.size()),
      body_of_(bodies_of(body.rest, body.material.pair.r)) {
  divide(surface);
  for (const Share& share : shares_) owns_[share.particle] = 1;
}

bool ContactPressure::any() const {
  const auto is_first = [&](std::int32_t body) { return body == body_of_.front(); };
  return (body_.world && !body_.world->obstacles.empty()) ||
         !std::all_of(body_of_.begin(), body_of_.end(), is_first);
}

void ContactPressure::divide(const Triangles& surface) {
  const double r = body_.material.pair.r, range = owned_range * r;
  const CellGrid grid(body_.rest, range);
  const auto owner = [&](const Vec3& place) {
    std::pair<double, std::int64_t> nearest = {range * range, -1};
    grid.for_each_near(place, [&](std::uint32_t i) {
      nearest = std::min(nearest, {(body_.rest[i] - place).squaredNorm(), std::int64_t{i}});
    });
    return nearest.second;
  };
  std::vector<std::vector<Share>> of_face(faces_.size());
  parallel_for(faces_.size(), faces_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      for_each_part(
          surface.points, faces_[f], part_size * r, [&](const Vec3& weights, double part) {
            const std::int64_t particle = owner(surface.points[faces_[f][0]] * weights[0] +
                                                surface.points[faces_[f][1]] * weights[1] +
                                                surface.points[faces_[f][2]] * weights[2]);
            if (particle < 0) return;
            std::vector<Share>& shares = of_face[f];
            const auto same = std::find_if(shares.begin(), shares.end(), [&](const Share& share) {
              return share.particle == particle;
            });
            if (same != shares.end())
              same->corner += part * weights;
            else
              shares.push_back({static_cast<std::uint32_t>(f), static_cast<std::uint32_t>(particle),
                                part * weights});
          });
  });
  for (const auto& shares : of_face) shares_.insert(shares_.end(), shares.begin(), shares.end());
}

/// Forces on the particles: of obstacles along their normals, and of particles of other bodies.
ContactPressure::Pressing ContactPressure::pressing(const Points& positions,
                                                    const Points& velocities,
                                                    std::span<const ObstaclePose> obstacles) const {
  const Material& material = body_.material;
  const ForceLaw& law = law_of(material);
  const double r = material.pair.r;
  const CellGrid grid(positions, 2 * r);
  const std::size_t count = positions.size();
  Pressing found = {std::vector<double>(count), Points(count, Vec3::Zero()),
                    Points(count, Vec3::Zero())};
  parallel_for(count, particles_pressed_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
      for (std::size_t k = 0; k < obstacles.size(); ++k) {
        const Contact touch =
            contact(body_.world->obstacles[k], obstacles[k], positions[i], velocities[i], r);
        found.force[i] += touch.pressing;
        found.along[i] += touch.pressing * touch.normal;
      }
      Vec3 of_others = Vec3::Zero();
      grid.for_each_near(positions[i], [&](std::uint32_t j) {
        const Vec3 apart = positions[i] - positions[j];
        const double d = apart.norm();
        if (body_of_[i] != body_of_[j] && d < 2 * r && d > 0 && !pass_through(body_, i, j))
          of_others += std::max(0.0, law.force(material, d)) / d * apart;
      });
      found.others[i] = of_others;
      found.along[i] += of_others;
    }
  });
  return found;
}

std::uint32_t ContactPressure::nearest_owner(std::uint32_t particle) const {
  std::pair<double, std::uint32_t> nearest = {std::numeric_limits<double>::infinity(), particle};
  for (std::uint32_t i = 0; i < owns_.size(); ++i)
    if (owns_[i] != 0)
      nearest = std::min(nearest, {(body_.rest[i] - body_.rest[particle]).squaredNorm(), i});
  return nearest.second;
}

SurfaceContact ContactPressure::at(const Points& points, const Points& positions,
                                   const Points& velocities,
                                   std::span<const ObstaclePose> obstacles) const {
  auto [force, others, along] = pressing(positions, velocities, obstacles);
  for (std::uint32_t i = 0; i < force.size(); ++i)
    if (!along[i].isZero(0) && owns_[i] == 0)  // deeper than the outermost layer
      if (const std::uint32_t owner = nearest_owner(i); owner != i)
        force[owner] += force[i], others[owner] += others[i], along[owner] += along[i];
  Points area;  // area vectors, one per face
  for (const auto& face : faces_) area.push_back(area_of(points, face));
  const auto faces_it = [&](const Share& share) {
    return -area[share.face].dot(along[share.particle]) >
           min_facing * area[share.face].norm() * along[share.particle].norm();
  };
  std::vector<double> owned(force.size()), facing(force.size());
  Points normal(force.size(), Vec3::Zero());  // normal of what faces it, by area
  for (const Share& share : shares_) {
    const double part = area[share.face].norm() * share.corner.sum();
    owned[share.particle] += part;
    if (!faces_it(share)) continue;
    facing[share.particle] += part;
    normal[share.particle] += share.corner.sum() * area[share.face];
  }
  for (std::size_t i = 0; i < force.size(); ++i)  // normals of others are tilted: they interlock
    force[i] +=
        facing[i] > 0 ? std::max(0.0, -others[i].dot(normal[i].normalized())) : others[i].norm();
  SurfaceContact on = {std::vector<double>(points.size()), std::vector<double>(points.size())};
  for (const Share& share : shares_) {
    const std::uint32_t i = share.particle;
    if (force[i] == 0 || owned[i] == 0 || (facing[i] > 0 && !faces_it(share))) continue;
    for (int k = 0; k < 3; ++k) {
      const double part = area[share.face].norm() * share.corner[k];
      const int v = faces_[share.face][k];
      on.area[v] += part;
      on.pressure[v] += part * force[i] / (facing[i] > 0 ? facing[i] : owned[i]);
    }
  }
  for (std::size_t v = 0; v < points.size(); ++v)
    if (on.area[v] > 0) on.pressure[v] /= on.area[v];
  return on;
}

}  // namespace sinew
