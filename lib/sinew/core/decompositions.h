// SPDX-License-Identifier: GPL-3.0-or-later
// Decompositions of matrices, small and dense. Eigen's solvers take seconds to compile, each for
// each type: these are compiled once.
//
//     const Vec3 squares = eigenvalues(F.transpose() * F);
#pragma once

#include <sinew/core/vector.h>

namespace sinew {

// 3 x 3

/// Eigenvalues, the smallest first, and unit eigenvectors, the columns of `axes` in the same order.
struct PrincipalAxes {
  Vec3 values;
  Mat3 axes;
};

/// Reads the lower triangle of a symmetric matrix; what is not finite gives what is not.
PrincipalAxes principal_axes(const Mat3& symmetric);

/// The values of principal_axes alone, bit for bit.
Vec3 eigenvalues(const Mat3& symmetric);

/// The same by a closed form: faster; where two are equal, exact to the root of the precision only.
Vec3 eigenvalues_in_closed_form(const Mat3& symmetric);

/// The symmetric matrix whose square is the inverse; all eigenvalues must be positive.
Mat3 inverse_root(const Mat3& symmetric);

/// U diag(values) V^T; the values, the largest first, are not negative.
struct SingularValues {
  Mat3 U;
  Vec3 values;
  Mat3 V;
};

SingularValues singular_values(const Mat3& matrix);

/// Orthogonal Q of a product Q R with an upper triangle, by Householder's reflections.
Mat3 orthogonal_factor(const Mat3& matrix);

/// Shortest rotation of one unit vector to another; a half turn about any axis for opposite ones.
Quat shortest_rotation(const Vec3& from, const Vec3& to);

// Any size

/// Eigenvalues, the smallest first, and unit eigenvectors as columns.
struct Eigendecomposition {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

Eigendecomposition eigendecomposition(const Eigen::MatrixXd& symmetric);

/// The values of eigendecomposition alone.
Eigen::VectorXd eigenvalues_of_symmetric(const Eigen::MatrixXd& symmetric);

Eigen::VectorXcd eigenvalues_of_any(const Eigen::MatrixXd& square);

/// The shortest x of those that minimize |A x - b|.
Eigen::VectorXd best_fit(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace sinew
