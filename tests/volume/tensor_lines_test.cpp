// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of principal stress in bars whose stresses are known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/mesh/clean.h>
#include <sinew/volume/tensor_lines.h>
#include "mesh/shapes.h"

namespace sinew::tensor_lines_test {

using Field = std::function<SymmetricTensor(const Vec3&)>;

constexpr double spacing = 0.25;

/// 2 m wide and deep, 6 m high, its axis along z through the origin.
const VolumeCells& bar() {
  static const VolumeCells cells = [] {
    const Surface surface = clean(shapes::box({-1, -1, -3}, {1, 1, 3}));
    PackOptions options;
    options.radius = 0.1;
    return volume_cells(surface, options, positions_of(pack(surface, options).particles));
  }();
  return cells;
}

std::vector<SymmetricTensor> tensors_of(const Field& field) {
  std::vector<SymmetricTensor> tensors;
  for (const Vec3& point : bar().points) tensors.push_back(field(point));
  return tensors;
}

std::vector<TensorLine> lines_of(const Field& field, TensorLineOptions options) {
  options.spacing = spacing;
  return tensor_lines(bar().points, bar().cells, tensors_of(field), options);
}

TEST(TensorLines, OfATwistedRoundBarAreHelicesAt45Degrees) {
  const Field twisted = [](const Vec3& p) { return SymmetricTensor{0, 0, 0, 0, p.x(), -p.y()}; };
  const std::vector<TensorLine> lines = lines_of(twisted, {.min_value = 0.4});
  ASSERT_GT(lines.size(), 20U);
  for (const TensorLine& line : lines) {
    const auto radius = [&](std::size_t i) {
      return std::hypot(line.points[i].x(), line.points[i].y());
    };
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      EXPECT_NEAR(radius(i), radius(0), 2e-3);
      EXPECT_NEAR(line.values[i], radius(i), 1e-9);
      EXPECT_GE(line.values[i], 0.4);
      if (i == 0) continue;
      const Vec3 along = (line.points[i] - line.points[i - 1]).normalized();
      EXPECT_NEAR(std::abs(along.z()), std::sqrt(0.5), 1e-3);
    }
  }
}

TEST(TensorLines, OfAPulledBarRunStraightFromEndToEnd) {
  const Field pulled = [](const Vec3&) { return SymmetricTensor{-1, -1, 5, 0, 0, 0}; };
  const std::vector<TensorLine> lines = lines_of(pulled, {});
  ASSERT_GT(lines.size(), 20U);
  for (const TensorLine& line : lines) {
    EXPECT_GT((line.points.front() - line.points.back()).norm(), 6 - spacing / 2);
    for (const Vec3& point : line.points)
      EXPECT_LT((point - line.points.front()).head<2>().norm(), 1e-9);
  }
}

TEST(TensorLines, KeepTheirDistance) {
  const Field pulled = [](const Vec3&) { return SymmetricTensor{0, 0, 5, 0, 0, 0}; };
  const std::vector<TensorLine> lines = lines_of(pulled, {});
  for (std::size_t a = 0; a < lines.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_GT((lines[a].points[0] - lines[b].points[0]).head<2>().norm(), 0.9 * spacing);
}

TEST(TensorLines, EndWhereTheTensorIsNotKnown) {
  const Field half = [](const Vec3& p) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return SymmetricTensor{0, 0, p.z() > 0 ? none : 1, 0, 0, 0};
  };
  const std::vector<TensorLine> lines = lines_of(half, {});
  ASSERT_GT(lines.size(), 20U);
  for (const TensorLine& line : lines)
    for (const Vec3& point : line.points) EXPECT_LT(point.z(), 1e-9);
}

TEST(TensorLines, GoOnceAroundInARing) {
  const Field hoops = [](const Vec3& p) {
    const Vec3 around = Vec3(-p.y(), p.x(), 0).normalized();
    return SymmetricTensor{
        around.x() * around.x(), around.y() * around.y(), 0, around.x() * around.y(), 0, 0};
  };
  for (const TensorLine& line : lines_of(hoops, {.min_value = 0.9})) {
    double turned = 0;
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      const Vec3 &a = line.points[i - 1], &b = line.points[i];
      turned += std::asin(a.cross(b).z() / std::hypot(a.x(), a.y()) / std::hypot(b.x(), b.y()));
    }
    EXPECT_LT(std::abs(turned), 2 * pi * 2.1);
  }
}

TEST(TensorLines, NeedASpacing) {
  EXPECT_THROW(tensor_lines(bar().points, bar().cells,
                            tensors_of([](const Vec3&) { return SymmetricTensor{}; }), {}),
               Error);
}

}  // namespace sinew::tensor_lines_test
