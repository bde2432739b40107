// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/detail/held_body.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <sinew/core/cell_grid.h>
#include <sinew/material/laws.h>

namespace sinew {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double small = 1e-6;  // size of displacements, in radii

/// What ties a body's particles near rest.
SolidBonds ties_of(const Body& body) {
  const Particles particles = particles_at(body.rest, body.material.pair.r, body.material.mass);
  const SharedNeighbors near = neighbors_of(body);
  if (law_of(body.material).has_bonds)
    return make_bonds(body.rest, near->all(), body.material, particles.id, body.factors);
  Material paper = body.material;
  paper.bond.stiffness = (paper.pair.contact_stiffness() + paper.pair.tension_stiffness()) / 2;
  return make_bonds(body.rest, near->all(), paper);
}

template <class Forces>
Matrix of_columns(const Matrix& u, const Forces& forces) {
  Matrix all(u.rows(), u.cols());
  for (Eigen::Index n = 0; n < u.cols(); ++n) all.col(n) = forces(u.col(n));
  return all;
}

Vector columns(const Points& vectors) {
  Vector all(3 * static_cast<Eigen::Index>(vectors.size()));
  for (std::size_t i = 0; i < vectors.size(); ++i)
    all.segment<3>(3 * static_cast<Eigen::Index>(i)) = vectors[i];
  return all;
}

}  // namespace

HeldBody::HeldBody(const Body& body, const Vector& mass, Holding holding)
    : body_(body),
      mass_(mass),
      holding_(std::move(holding)),
      particles_(particles_at(body.rest, body.material.pair.r, body.material.mass)) {
  body_.material.damping = 1;
  if (remembers_neighbors(body.material))
    solid_.emplace(body_.material, body_.rest, particles_.id, body_.factors, body_.local);
  assemble();
}

namespace {

/// Each particle's block times its rows.
Matrix by_blocks(const std::vector<Mat3>& blocks, const Matrix& u) {
  Matrix all(u.rows(), u.cols());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    all.middleRows<3>(at) = blocks[i] * u.middleRows<3>(at);
  }
  return all;
}

}  // namespace

Matrix HeldBody::free_part(Matrix u) const {
  return holding_.empty() ? u : by_blocks(holding_.free, u);
}

Matrix HeldBody::stiffness(const Matrix& u) {
  if (!keeps_volume(body_)) return free_part(springs_ * u);
  Matrix forces = of_columns(u, [this](const Vector& one) -> Vector {
    const double scale = small * body_.material.pair.r / one.cwiseAbs().maxCoeff();
    return (pair_forces_at(-scale * one) - pair_forces_at(scale * one)) / (2 * scale);
  });
  if (!holding_.empty()) forces += by_blocks(holding_.springs, u);
  return free_part(forces);
}

Matrix HeldBody::damping_of_bones(const Matrix& u) const {
  return holding_.empty() ? Matrix(Matrix::Zero(u.rows(), u.cols()))
                          : free_part(by_blocks(holding_.damping, u));
}

Matrix HeldBody::held_energy(const Matrix& u) const {
  if (holding_.empty()) return Matrix::Zero(u.cols(), u.cols());
  return u.transpose() *
         (by_blocks(holding_.springs, u) + stiffest_ * (u - by_blocks(holding_.free, u)));
}

Matrix HeldBody::damping(const Matrix& u) {
  return of_columns(u, [this](const Vector& one) -> Vector {
    move(Vector::Zero(one.size()), one);
    find_forces();
    return -columns(forces_.damping);
  });
}

void HeldBody::move(const Vector& by, const Vector& velocity) {
  for (std::size_t i = 0; i < body_.rest.size(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    particles_.set_position(i, body_.rest[i] + by.segment<3>(at));
    particles_.set_velocity(i, velocity.segment<3>(at));
  }
}

Vector HeldBody::pair_forces_at(const Vector& by) {
  move(by, Vector::Zero(by.size()));
  find_forces();
  return columns(forces_.pair);
}

void HeldBody::find_forces() {
  if (solid_)
    solid_->forces(particles_, forces_);
  else
    pair_forces(particles_, body_.material, forces_);
}

void HeldBody::assemble() {
  const SolidBonds ties = ties_of(body_);
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](std::size_t i, std::size_t j, const Mat3& block) {
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        entries.emplace_back(3 * static_cast<int>(i) + a, 3 * static_cast<int>(j) + b, block(a, b));
  };
  const auto free = [&](std::size_t i) -> Mat3 {
    return holding_.empty() ? Mat3(Mat3::Identity()) : holding_.free[i];
  };
  for (const Bonds* bonds : {&ties.nearest, &ties.second})
    for (std::size_t i = 0; i < body_.rest.size(); ++i)
      for (std::uint32_t e = bonds->neighbors.first[i]; e < bonds->neighbors.first[i + 1]; ++e) {
        const std::uint32_t j = bonds->neighbors.neighbor[e];
        const Vec3 n = (body_.rest[i] - body_.rest[j]).normalized();
        const Mat3 block = bonds->stiffness[e] * n * n.transpose();
        stiffest_ = std::max(stiffest_, bonds->stiffness[e]);
        add(i, i, free(i) * block * free(i));
        add(i, j, -free(i) * block * free(j));
      }
  for (std::size_t i = 0; i < holding_.springs.size(); ++i)
    add(i, i, free(i) * holding_.springs[i] * free(i) + stiffest_ * (Mat3::Identity() - free(i)));
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(body_.rest.size());
  springs_.resize(rows, rows);
  springs_.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace sinew
