// SPDX-License-Identifier: GPL-3.0-or-later
// Equal particles as a structure of arrays. The order may change during a simulation; `id` is each
// particle's place in the order in which files are written, which never changes.
//
//     Particles particles = particles_at(positions, radius, mass);
//     particles.set_velocity(i, velocity);
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

// Closest packing of equal spheres of radius r: what FCC and HCP have in common.

/// Distance of nearest neighbors, d0 = 2r. Each inner particle has 12 of them.
constexpr double nearest_distance(double r) { return 2 * r; }

/// Distance of the 6 second neighbors, 2 sqrt(2) r.
constexpr double second_distance(double r) { return 2 * std::numbers::sqrt2 * r; }

/// Distance between the half-planes of FCC along a cube axis, sqrt(2) r.
constexpr double half_plane_spacing(double r) { return std::numbers::sqrt2 * r; }

/// Volume per particle, V0 = 4 sqrt(2) r^3: of the lattice cell; the sphere's is 26 % less.
constexpr double volume_per_particle(double r) { return 4 * std::numbers::sqrt2 * r * r * r; }

/// A slab this thick contains particles wherever it is: no point is farther than sqrt(2) r from the
/// nearest site.
constexpr double surely_filled_thickness(double r) { return 2 * std::numbers::sqrt2 * r; }

/// Pairs closer than this at rest are neighbors: between first (2r) and second (2.83r) shell.
constexpr double rest_neighbor_range(double r) { return 2.2 * r; }
/// Number of neighbors of an inner particle in a closest packing.
inline constexpr std::size_t max_neighbors_at_rest = 12;

struct Particles {
  double radius = 0;  ///< radius of each particle, m
  double mass = 0;    ///< mass of each particle, kg

  std::vector<double> x, y, z;   ///< positions, m
  std::vector<double> u, v, w;   ///< velocities, m/s
  std::vector<std::int32_t> id;  ///< place in the written order, 0 .. size() - 1

  std::size_t size() const { return x.size(); }
  Vec3 position(std::size_t i) const { return {x[i], y[i], z[i]}; }
  Vec3 velocity(std::size_t i) const { return {u[i], v[i], w[i]}; }
  void set_position(std::size_t i, const Vec3& p) { x[i] = p.x(), y[i] = p.y(), z[i] = p.z(); }
  void set_velocity(std::size_t i, const Vec3& p) { u[i] = p.x(), v[i] = p.y(), w[i] = p.z(); }
};

/// Frees positions and velocities; ids stay.
void free_motion(Particles& particles);

/// `count` particles at rest at the origin, ids in order.
Particles particles_at_rest(std::size_t count);

/// Particles at rest at `positions` (n x 3, m), in that order.
Particles particles_at(const Points& positions, double radius, double mass);

/// Positions (n x 3, m) in the order of `particles`, not the written one.
Points positions_of(const Particles& particles);

/// Positions and velocities by id (n x 3, m and m/s), in parallel.
Points positions_by_id(const Particles& particles);
void find_positions_by_id(const Particles& particles, Points& positions);
void find_velocities_by_id(const Particles& particles, Points& velocities);

/// A hash of every bit of positions and velocities in the written order.
std::uint64_t state_hash(const Particles& particles);

}  // namespace sinew
