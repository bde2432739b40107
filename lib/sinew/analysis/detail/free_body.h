// SPDX-License-Identifier: GPL-3.0-or-later
// The forces between a body's particles near rest, without bones and surroundings: K u - D v.
//
//     FreeBody free(body, mass);
//     const Eigen::MatrixXd forces = free.stiffness(displacements);
#pragma once

#include <Eigen/SparseCore>
#include <optional>

#include <sinew/body/body.h>
#include <sinew/body/forces.h>
#include <sinew/body/solid.h>
#include <sinew/core/particles.h>

namespace sinew {

/// Forces of displacements in columns: 3 rows a particle.
class FreeBody {
 public:
  /// `mass` by row, kg.
  FreeBody(const Body& body, const Eigen::VectorXd& mass);

  const Body& body() const { return body_; }
  const Eigen::VectorXd& mass() const { return mass_; }
  /// What the springs between neighbors at rest add to K, N/m: all of it where no volume is kept.
  const Eigen::SparseMatrix<double>& springs() const { return springs_; }

  Eigen::MatrixXd with_mass(const Eigen::MatrixXd& u) const { return mass_.asDiagonal() * u; }
  /// K u, N.
  Eigen::MatrixXd stiffness(const Eigen::MatrixXd& u);
  /// D u, N: of eq. 2 for C = 1 kg/s and velocities u.
  Eigen::MatrixXd damping(const Eigen::MatrixXd& u);

 private:
  void assemble();
  void move(const Eigen::VectorXd& by, const Eigen::VectorXd& velocity);
  void find_forces();
  Eigen::VectorXd pair_forces_at(const Eigen::VectorXd& by);

  Body body_;
  Eigen::VectorXd mass_;
  Particles particles_;
  std::optional<Solid> solid_;
  Eigen::SparseMatrix<double> springs_;
  Forces forces_;
};

}  // namespace sinew
