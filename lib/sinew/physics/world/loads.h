// SPDX-License-Identifier: GPL-3.0-or-later
// Forces that a testing machine puts on parts of a body: a force, a traction or a weight, which
// keep their direction, and a pressure, which follows the surface.
//
//     LoadNow now(load);
//     now.find(load, load.scale.at(time), [&](std::size_t k) { return position_of(k); });
//     force += now.force(k);   // on particle load.particles[k]
//
// A pressure p acts on triangles whose corners y follow the particles: p A n / 3 inward on each
// corner, with the area and the normal of the moment, and from there by the corner's weights on
// particles. On a closed surface forces and moments so sum to zero, and the work is p times the
// volume that is lost.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <sinew/core/parallel.h>
#include <sinew/core/triangles.h>
#include <sinew/physics/forces.h>
#include <sinew/physics/world/following_points.h>
#include <sinew/physics/world/region.h>

namespace sinew {

struct Load {
  std::string name;
  KeyedValue scale;                            ///< over time; 1 without keys
  std::vector<std::uint32_t> particles;        ///< on which it acts, by id, ascending
  std::vector<double> share;                   ///< of each of them in `force`; sums to 1
  Vec3 force = Vec3::Zero();                   ///< the sum, N
  double pressure = 0;                         ///< Pa, in addition
  std::vector<std::array<int, 3>> faces = {};  ///< on which it acts, of `corners`
  FollowingPoints corners = {};                ///< of places in `particles`
  Vec3 pivot = Vec3::Zero();                   ///< of its moment, m
};

/// A force (N) shared by particles as listed, with the same number more than once if need be:
/// shares are summed and made to sum to 1. Its pivot is the mean of `rest` (m) by shares. Throws
/// bad input, which names it, for no particles and shares that cancel.
Load force_load(const std::string& name, const std::vector<std::uint32_t>& particles,
                const std::vector<double>& shares, const Vec3& force, const Points& rest);

/// As many particles each corner of a pressure follows: of two layers, at least.
inline constexpr std::size_t followed_by_corners = 12;

/// No side of a pressed face need be shorter, in radii: each corner pushes as many particles of the
/// outermost layer as there are for each corner, and with 3 instead the stress at the surface is as
/// even.
inline constexpr double longest_pressed_side = 4;

/// A pressure (Pa) on all faces of a surface whose points follow the particles at `rest` with
/// `radius` (m); its shares are those of the area. Throws bad input for no faces.
Load pressure_load(const std::string& name, const Triangles& surface, double pressure,
                   const Points& rest, double radius);

/// The area of the faces around each point, as a force on it that is shared by area: (particle,
/// share) pairs for force_load(), of points that follow the particles at `rest`.
struct AreaShares {
  std::vector<std::uint32_t> particles;
  std::vector<double> shares;  ///< m^2
  double area = 0;             ///< m^2
};
AreaShares area_shares(const Triangles& surface, const Points& rest, double radius);

/// The forces of a load at one moment.
class LoadNow {
 public:
  explicit LoadNow(const Load& load);

  /// Finds the forces at a moment; `position(k)`: of load.particles[k], m. In parallel; the same
  /// bits for any number of threads.
  template <class Position>
  void find(const Load& load, double scale, const Position& position) {
    if (!load.faces.empty())
      parallel_for(load.particles.size(), particles_per_task,
                   [&](std::size_t begin, std::size_t end) {
                     for (std::size_t k = begin; k < end; ++k) at_[k].head<3>() = position(k);
                   });
    find_forces(load, scale);
  }

  Vec3 force(std::size_t k) const { return forces_[k].head<3>(); }  ///< on load.particles[k], N
  /// Of its forces as found last, those of a pressure by their lengths, N.
  double size(const Load& load, double scale) const;

 private:
  static constexpr std::size_t particles_per_task = 512;
  using Four = Eigen::Vector4d;  ///< as two pairs: x, y, z, 0

  /// Sums over entries of rows: row k has the entries [first[k], first[k + 1]).
  struct Weights {
    std::vector<std::uint32_t> first, source;
    std::vector<double> weight;

    Four sum(std::size_t k, const std::vector<Four>& of) const {
      Four all = Four::Zero();
      for (std::uint32_t e = first[k]; e < first[k + 1]; ++e) all += weight[e] * of[source[e]];
      return all;
    }
  };

  void order_corners(const Load& load);
  void find_forces(const Load& load, double scale);
  void find_pressure(const Load& load, double scale);

  Weights of_corners_, of_particles_, of_faces_;  ///< corners from particles, and back; from faces
  std::vector<std::array<std::uint32_t, 3>> face_;
  std::vector<Four> at_, corner_, area_, pushed_, forces_;
};

/// An upper bound of the stiffness that a load adds to a particle of `radius` (m), N/m.
double load_stiffness(const Load& load, double radius);

/// Throws bad input, which names the load, for numbers that are not finite and bad keys.
void check_load(const Load& load);

}  // namespace sinew
