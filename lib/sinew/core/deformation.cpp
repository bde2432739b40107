// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/deformation.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t points_at_a_time = 1024;
// Neighbors of a closest packing give eigenvalues of 4 d0^2; a flat set gives 0 up to rounding.
constexpr double flat = 1e-6;

Mat3 inverse_or_zero(const Mat3& spread) {
  const Vec3 eigenvalues = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvalues();
  if (!(eigenvalues[0] > flat * eigenvalues[2])) return Mat3::Zero();
  return spread.inverse();
}

/// Turns one unit vector to the other; a half turn, of any axis, where they are opposite. Eigen's
/// FromTwoVectors does the same by a singular value decomposition that takes seconds to compile.
Mat3 shortest_rotation(const Vec3& from, const Vec3& to) {
  const double cosine = from.dot(to);
  if (!(cosine > -1 + 1e-12)) return Eigen::AngleAxisd(pi, from.unitOrthogonal()).matrix();
  const double twice_w = std::sqrt(2 * (1 + cosine));
  const Vec3 v = from.cross(to) / twice_w;
  return Quat(twice_w / 2, v.x(), v.y(), v.z()).toRotationMatrix();
}

Mat3 spread_of(const RestShape& rest, std::size_t i) {
  Mat3 spread = Mat3::Zero();
  for (const auto j : rest.neighbors.of(i)) {
    const Vec3 offset = rest.points[j] - rest.points[i];
    spread += offset * offset.transpose();
  }
  return spread;
}

}  // namespace

RestShape rest_shape(Points points, double range) {
  NeighborLists near = neighbors_within(points, range);
  return rest_shape(std::move(points), std::move(near));
}

RestShape rest_shape(Points points, NeighborLists neighbors) {
  RestShape rest;
  rest.neighbors = std::move(neighbors);
  rest.points = std::move(points);
  rest.inverse.resize(rest.points.size());
  parallel_for(rest.points.size(), points_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) rest.inverse[i] = inverse_or_zero(spread_of(rest, i));
  });
  return rest;
}

Mat3 moved_spread(const RestShape& rest, const Points& now, std::size_t i) {
  Mat3 moved = Mat3::Zero();
  for (const auto j : rest.neighbors.of(i))
    moved += (now[j] - now[i]) * (rest.points[j] - rest.points[i]).transpose();
  return moved;
}

Mat3 deformation_gradient(const RestShape& rest, const Points& now, std::size_t i) {
  if (!rest.defined(i)) return Mat3::Identity();
  return moved_spread(rest, now, i) * rest.inverse[i];
}

Mat3 rotation_part(const Mat3& F) {
  const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3& sizes = svd.singularValues();
  if (!(sizes[1] > flat * sizes[0]))  // of a line: the shortest rotation; of a point: none
    return sizes[0] > 0 ? shortest_rotation(svd.matrixV().col(0), svd.matrixU().col(0))
                        : Mat3(Mat3::Identity());
  Mat3 U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0)
    U.col(2) *= -1;  // the least stretched direction
  return U * svd.matrixV().transpose();
}

}  // namespace sinew
