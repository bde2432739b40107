// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/detail/nearly_solved.h>

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <sinew/core/fcc.h>

namespace sinew {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr std::size_t max_solved = 4000;  // exactly: beyond, the factors fill up
constexpr std::size_t groups_wanted = 1000;
constexpr int max_iterations = 60;

}  // namespace

NearlySolved::NearlySolved(const HeldBody& held, double shift) : matrix_(held.springs()) {
  matrix_.diagonal() += shift * held.mass();
  const Body& body = held.body();
  if (body.rest.size() <= max_solved) {
    solver_.compute(matrix_);
    return;
  }
  group(body);
  Sparse grouped = groups_.transpose() * matrix_ * groups_;
  // Groups of one or two particles have fewer motions.
  grouped.diagonal() += Vector::Constant(grouped.rows(), 1e-9 * grouped.diagonal().maxCoeff());
  solver_.compute(grouped);
  inverse_ = matrix_.diagonal().cwiseInverse() / 2;
}

Matrix NearlySolved::solve(const Matrix& b) const {
  if (groups_.cols() == 0) return solver_.solve(b);
  return groups_ * solver_.solve(Matrix(groups_.transpose() * b)) + inverse_.asDiagonal() * b;
}

Vector NearlySolved::solve_well(const Vector& b) const {
  Vector x = solve(b);
  if (groups_.cols() == 0) return x;
  Vector residual = b - matrix_ * x, preconditioned = solve(residual), along = preconditioned;
  double product = residual.dot(preconditioned);
  const double enough = 1e-8 * b.dot(x);
  for (int n = 0; n < max_iterations && product > enough; ++n) {
    const Vector forces = matrix_ * along;
    const double step = product / along.dot(forces);
    x += step * along;
    residual -= step * forces;
    preconditioned = solve(residual);
    const double next = residual.dot(preconditioned);
    along = preconditioned + next / product * along;
    product = next;
  }
  return x;
}

void NearlySolved::group(const Body& body) {
  const double larger =
      std::cbrt(static_cast<double>(body.rest.size()) / static_cast<double>(groups_wanted));
  const double unit = std::numbers::sqrt2 * body.material.pair.r * larger;
  std::map<FccSite, int> number;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < body.rest.size(); ++i) {
    const FccSite site = nearest_fcc_site(body.lattice.transpose() * body.rest[i] / unit);
    const int group = number.try_emplace(site, static_cast<int>(number.size())).first->second;
    const Vec3 from = body.rest[i] / unit - body.lattice * Vec3(site[0], site[1], site[2]);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 turned = Vec3::Unit(axis).cross(from);
      entries.emplace_back(3 * static_cast<int>(i) + axis, 6 * group + axis, 1);
      for (int row = 0; row < 3; ++row)
        if (row != axis)
          entries.emplace_back(3 * static_cast<int>(i) + row, 6 * group + 3 + axis, turned[row]);
    }
  }
  groups_.resize(matrix_.rows(), 6 * static_cast<Eigen::Index>(number.size()));
  groups_.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace sinew
