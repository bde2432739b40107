// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/detail/free_body.h>

#include <vector>

#include <sinew/core/cell_grid.h>
#include <sinew/material/laws.h>

namespace sinew {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double small = 1e-6;  // of displacements, in radii

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

FreeBody::FreeBody(const Body& body, const Vector& mass)
    : body_(body),
      mass_(mass),
      particles_(particles_at(body.rest, body.material.pair.r, body.material.mass)) {
  body_.material.damping = 1;
  if (remembers_neighbors(body.material))
    solid_.emplace(body_.material, body_.rest, particles_.id, body_.factors, body_.local);
  assemble();
}

Matrix FreeBody::stiffness(const Matrix& u) {
  if (!keeps_volume(body_)) return springs_ * u;
  return of_columns(u, [this](const Vector& one) -> Vector {
    const double scale = small * body_.material.pair.r / one.cwiseAbs().maxCoeff();
    return (pair_forces_at(-scale * one) - pair_forces_at(scale * one)) / (2 * scale);
  });
}

Matrix FreeBody::damping(const Matrix& u) {
  return of_columns(u, [this](const Vector& one) -> Vector {
    move(Vector::Zero(one.size()), one);
    find_forces();
    return -columns(forces_.damping);
  });
}

void FreeBody::move(const Vector& by, const Vector& velocity) {
  for (std::size_t i = 0; i < body_.rest.size(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    particles_.set_position(i, body_.rest[i] + by.segment<3>(at));
    particles_.set_velocity(i, velocity.segment<3>(at));
  }
}

Vector FreeBody::pair_forces_at(const Vector& by) {
  move(by, Vector::Zero(by.size()));
  find_forces();
  return columns(forces_.pair);
}

void FreeBody::find_forces() {
  if (solid_)
    solid_->forces(particles_, forces_);
  else
    pair_forces(particles_, body_.material, forces_);
}

void FreeBody::assemble() {
  const SolidBonds ties = ties_of(body_);
  std::vector<Eigen::Triplet<double>> entries;
  for (const Bonds* bonds : {&ties.nearest, &ties.second})
    for (std::size_t i = 0; i < body_.rest.size(); ++i)
      for (std::uint32_t e = bonds->neighbors.first[i]; e < bonds->neighbors.first[i + 1]; ++e) {
        const std::uint32_t j = bonds->neighbors.neighbor[e];
        const Vec3 n = (body_.rest[i] - body_.rest[j]).normalized();
        const Mat3 block = bonds->stiffness[e] * n * n.transpose();
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) {
            const auto row = 3 * static_cast<int>(i) + a;
            entries.emplace_back(row, 3 * static_cast<int>(i) + b, block(a, b));
            entries.emplace_back(row, 3 * static_cast<int>(j) + b, -block(a, b));
          }
      }
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(body_.rest.size());
  springs_.resize(rows, rows);
  springs_.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace sinew
