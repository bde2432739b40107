// SPDX-License-Identifier: GPL-3.0-or-later
// The forces on a body's particles near rest, by each other and by what holds them: K u - D v.
//
//     HeldBody held(body, mass, holding);
//     const Eigen::MatrixXd forces = held.stiffness(displacements);
#pragma once

#include <Eigen/SparseCore>
#include <optional>

#include <sinew/analysis/detail/holding.h>
#include <sinew/body/body.h>
#include <sinew/body/forces.h>
#include <sinew/body/solid.h>
#include <sinew/core/particles.h>

namespace sinew {

/// Forces of displacements in columns: 3 rows a particle. Displacements are those that pins and
/// supports leave free.
class HeldBody {
 public:
  /// `mass` by row, kg.
  HeldBody(const Body& body, const Eigen::VectorXd& mass, Holding holding);

  const Body& body() const { return body_; }
  const Eigen::VectorXd& mass() const { return mass_; }
  /// What springs add to K, N/m: all of it where no volume is kept. Of rows that are held, some
  /// positive stiffness.
  const Eigen::SparseMatrix<double>& springs() const { return springs_; }
  bool held() const { return !holding_.empty(); }

  Eigen::MatrixXd with_mass(const Eigen::MatrixXd& u) const { return mass_.asDiagonal() * u; }
  /// K u, N.
  Eigen::MatrixXd stiffness(const Eigen::MatrixXd& u);
  /// D u, N: of eq. 2 for C = 1 kg/s and velocities u.
  Eigen::MatrixXd damping(const Eigen::MatrixXd& u);
  /// The same of the damping of bones.
  Eigen::MatrixXd damping_of_bones(const Eigen::MatrixXd& u) const;
  /// The part of displacements that nothing prescribes.
  Eigen::MatrixXd free_part(Eigen::MatrixXd u) const;
  /// The energy, over half the square of the displacement, that holds against them: by springs of
  /// bones, and by others where pins and supports are; J/m^2.
  Eigen::MatrixXd held_energy(const Eigen::MatrixXd& u) const;

 private:
  void assemble();
  void move(const Eigen::VectorXd& by, const Eigen::VectorXd& velocity);
  void find_forces();
  Eigen::VectorXd pair_forces_at(const Eigen::VectorXd& by);

  Body body_;
  Eigen::VectorXd mass_;
  Holding holding_;
  double stiffest_ = 0;  ///< N/m
  Particles particles_;
  std::optional<Solid> solid_;
  Eigen::SparseMatrix<double> springs_;
  Forces forces_;
};

}  // namespace sinew
