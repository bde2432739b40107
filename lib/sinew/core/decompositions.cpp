// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/decompositions.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace sinew {

using Symmetric3 = Eigen::SelfAdjointEigenSolver<Mat3>;
using Symmetric = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

PrincipalAxes principal_axes(const Mat3& symmetric) {
  const Symmetric3 solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Vec3 eigenvalues(const Mat3& symmetric) {
  return Symmetric3(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

Vec3 eigenvalues_in_closed_form(const Mat3& symmetric) {
  return Symmetric3().computeDirect(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

Mat3 inverse_root(const Mat3& symmetric) { return Symmetric3(symmetric).operatorInverseSqrt(); }

SingularValues singular_values(const Mat3& matrix) {
  const Eigen::JacobiSVD<Mat3> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

Mat3 orthogonal_factor(const Mat3& matrix) {
  return Eigen::HouseholderQR<Mat3>(matrix).householderQ();
}

Quat shortest_rotation(const Vec3& from, const Vec3& to) {
  const double cosine = from.dot(to);
  if (!(cosine > -1 + 1e-12)) return Quat(Eigen::AngleAxisd(pi, from.unitOrthogonal()));
  const double twice_w = std::sqrt(2 * (1 + cosine));
  const Vec3 v = from.cross(to) / twice_w;
  return {twice_w / 2, v.x(), v.y(), v.z()};
}

Eigendecomposition eigendecomposition(const Eigen::MatrixXd& symmetric) {
  const Symmetric solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd eigenvalues_of_symmetric(const Eigen::MatrixXd& symmetric) {
  return Symmetric(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigen::VectorXcd eigenvalues_of_any(const Eigen::MatrixXd& square) { return square.eigenvalues(); }

Eigen::VectorXd best_fit(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.completeOrthogonalDecomposition().solve(b);
}

}  // namespace sinew
