// SPDX-License-Identifier: GPL-3.0-or-later
// The tangent stiffness of a body among all that acts on it, -df/dx of what is free to move, by
// differences of the stepper's own forces: particles that share no neighbor are moved at once.
// (Curtis, Powell and Reid, On the estimation of sparse Jacobian matrices, 1974.)
//
//     const Tangent tangent(body, neighbors, id);
//     const Eigen::SparseMatrix<double> K = tangent.at(stepper, moment, positions);
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/core/rest_neighbors.h>
#include <sinew/stepping/stepper.h>

namespace sinew {

class Tangent {
 public:
  using Matrix = Eigen::SparseMatrix<double>;
  using Vector = Eigen::VectorXd;

  /// `id` of the particles in the caller's order, in which everything here is.
  Tangent(const Body& body, const RestNeighbors& near, std::span<const std::int32_t> id);

  Eigen::Index unknowns() const { return unknowns_; }  ///< components that nothing holds
  /// Entries that K may have, each 1.
  Matrix pattern() const;
  /// K (N/m), made symmetric: what follows a body's surface is not. At `positions` (m), which the
  /// stepper has, and has again afterwards.
  Matrix at(Stepper& stepper, const TimedPose& now, const Points& positions) const;
  /// Forces on what is free (N) where the stepper has the body; `gravity` in m/s^2.
  Vector forces(Stepper& stepper, const TimedPose& now, const Vec3& gravity) const;
  /// Positions moved by displacements of what is free (m).
  Points moved(Points positions, const Vector& by) const;
  /// The largest difference of such displacements of two particles that reach each other, over
  /// their distance.
  double largest_gradient(const Points& positions, const Vector& by) const;

 private:
  void find_colors();

  double step_;               ///< size of differences, m
  NeighborLists reached_;     ///< particles whose forces each one changes, itself included
  std::vector<double> mass_;  ///< kg
  std::vector<std::array<std::int32_t, 3>> unknown_;  ///< one per particle and axis; -1: held
  Eigen::Index unknowns_ = 0;
  std::vector<std::vector<std::uint32_t>> of_color_;  ///< particles
};

}  // namespace sinew
