// SPDX-License-Identifier: GPL-3.0-or-later
// Solves (K + shift M) x = b for the springs K of a body: exactly for small bodies; of larger ones
// nearly, by the rigid motions of groups of particles and the stiffness of each particle alone.
//
//     const NearlySolved solver(held, shift);
//     const Eigen::MatrixXd x = solver.solve(b);
#pragma once

#include <Eigen/SparseCholesky>

#include <sinew/analysis/detail/held_body.h>

namespace sinew {

class NearlySolved {
 public:
  /// `shift` in 1/s^2.
  NearlySolved(const HeldBody& held, double shift);

  bool sound() const { return solver_.info() == Eigen::Success; }
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  /// Solves by conjugate gradients, to some digits.
  Eigen::VectorXd solve_well(const Eigen::VectorXd& b) const;

 private:
  void group(const Body& body);

  Eigen::SparseMatrix<double> matrix_, groups_;  ///< rigid motions of the groups, as columns
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
  Eigen::VectorXd inverse_;
};

}  // namespace sinew
