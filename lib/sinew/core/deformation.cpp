// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/deformation.h>

#include <algorithm>
#include <limits>

#include <sinew/core/decompositions.h>
#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t points_at_a_time = 1024;
// Neighbors of a closest packing give eigenvalues of 4 d0^2; a flat set gives 0 up to rounding.
constexpr double flat = 1e-6;

Mat3 inverse_or_zero(const Mat3& spread) {
  const Vec3 values = eigenvalues(spread);
  if (!(values[0] > flat * values[2])) return Mat3::Zero();
  return spread.inverse();
}

template <class Counts>
Mat3 spread_of(const RestShape& rest, std::size_t i, Counts counts) {
  Mat3 spread = Mat3::Zero();
  for (const auto j : rest.neighbors.of(i)) {
    if (!counts(j)) continue;
    const Vec3 offset = rest.points[j] - rest.points[i];
    spread += offset * offset.transpose();
  }
  return spread;
}

Mat3 spread_of(const RestShape& rest, std::size_t i) {
  return spread_of(rest, i, [](std::uint32_t) { return true; });
}

/// The inverse over those neighbors that are there now.
Mat3 inverse_of_present(const RestShape& rest, const Points& now, std::size_t i) {
  const auto is_there = [&](std::uint32_t j) { return now[j].allFinite(); };
  const auto neighbors = rest.neighbors.of(i);
  if (!is_there(static_cast<std::uint32_t>(i))) return Mat3::Zero();
  if (std::all_of(neighbors.begin(), neighbors.end(), is_there)) return rest.inverse[i];
  return inverse_or_zero(spread_of(rest, i, is_there));
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

double non_affine(const RestShape& rest, const Points& now, const Mat3& F, std::size_t i) {
  double sum = 0;
  const auto neighbors = rest.neighbors.of(i);
  for (const auto j : neighbors)
    sum += ((now[j] - now[i]) - F * (rest.points[j] - rest.points[i])).squaredNorm();
  return sum / static_cast<double>(neighbors.size());
}

AffineFit affine_fit(const RestShape& rest, const Points& now, std::size_t i) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const Mat3 inverse = inverse_of_present(rest, now, i);
  if (inverse.isZero(0)) return {Mat3::Constant(unknown), unknown};
  AffineFit fit{Mat3::Zero(), 0};
  for (int pass = 0; pass < 2; ++pass) {
    Mat3 moved = Mat3::Zero();
    double squares = 0, count = 0;
    for (const auto j : rest.neighbors.of(i)) {
      const Vec3 at_rest = rest.points[j] - rest.points[i];
      const Vec3 left = now[j] - now[i] - fit.F * at_rest;
      if (!left.allFinite()) continue;
      moved += left * at_rest.transpose();
      squares += left.squaredNorm();
      ++count;
    }
    fit.D2min = squares / count;
    fit.F += moved * inverse;
  }
  return fit;
}

Mat3 rotation_part(const Mat3& F) {
  auto [U, sizes, V] = singular_values(F);
  if (!(sizes[1] > flat * sizes[0]))  // line: the shortest rotation; point: none
    return sizes[0] > 0 ? shortest_rotation(V.col(0), U.col(0)).toRotationMatrix()
                        : Mat3(Mat3::Identity());
  if ((U * V.transpose()).determinant() < 0) U.col(2) *= -1;  // the least stretched direction
  return U * V.transpose();
}

}  // namespace sinew
