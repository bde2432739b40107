// SPDX-License-Identifier: GPL-3.0-or-later
// Forces on particles whose neighbors at rest all move with them, x = c + F X: they follow from F
// and its rate alone. Sums over many particles need only a few sums of what is constant, made once:
// of their bonds by direction, and of these times their places.
//
//     const AffineForces forces(body);
//     sums += forces.moments_of(i, X);
//     const AffineSum pull = forces.at(sums, F, rate);
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sinew/core/cell_grid.h>
#include <sinew/core/vector.h>
#include <sinew/material/material.h>

namespace sinew {

struct Body;

/// Neighbors of a site of FCC: twelve nearest ones, then six second ones.
inline constexpr int nearest_sites = 12, near_sites = 18;

/// Whether all forces between particles follow from the bonds at rest: then nothing else counts
/// for those whose neighbors move with them.
bool has_affine_forces(const Body& body);

/// Sums over particles at places X, in any units, of what depends on their neighbors at rest.
struct AffineMoments {
  std::array<double, near_sites> bonds{};  ///< factors on their stiffness, by direction
  std::array<Vec3, near_sites> bonds_X;    ///< times X
  Vec3 behind = Vec3::Zero();              ///< vector from each to the mean of its neighbors, m
  Mat3 behind_X = Mat3::Zero();
  Vec3 swell = Vec3::Zero();  ///< sum for the stiffness of volumes, N
  Mat3 swell_X = Mat3::Zero();

  AffineMoments() { bonds_X.fill(Vec3::Zero()); }
  AffineMoments& operator+=(const AffineMoments& other) { return add(other, 1); }
  AffineMoments& operator-=(const AffineMoments& other) { return add(other, -1); }

 private:
  AffineMoments& add(const AffineMoments& other, double times);
};

/// Sums of forces (N), and of them times X.
struct AffineSum {
  Vec3 f = Vec3::Zero();
  Mat3 fX = Mat3::Zero();
};

class AffineForces {
 public:
  /// The body must stay where it is.
  explicit AffineForces(const Body& body);

  /// The place of a neighbor among the sites, from one particle to it, or -1: at no site.
  int site_of(const Vec3& from_to) const;
  /// Returns the vectors from a particle to each, m.
  const Points& sites() const { return site_; }
  AffineMoments moments_of(std::uint32_t i, const Vec3& X) const;

  /// Between neighbors, without damping.
  AffineSum at(const AffineMoments& moments, const Mat3& F) const;
  /// Returns the damping of eq. 2, towards the mean velocity of the neighbors.
  AffineSum damping(const AffineMoments& moments, const Mat3& rate) const;

 private:
  void append_near(std::uint32_t i, std::vector<std::uint32_t>& near) const;
  Mat3 swell_of(std::uint32_t i) const;

  const Body* body_;
  bool keeps_volume_;
  double range_;  ///< range of neighbors, m
  CellGrid grid_;
  Points site_;                ///< m
  std::array<int, 125> at_{};  ///< sites by whole coordinates in half-planes, -2 to 2 each
};

}  // namespace sinew
