// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/detail/group_shapes.h>

#include <Eigen/LU>
#include <algorithm>
#include <cstdint>

#include <sinew/body/body.h>
#include <sinew/body/grouping.h>
#include <sinew/core/decompositions.h>
#include <sinew/core/parallel.h>

namespace sinew {
namespace {

using Products = Eigen::Matrix<double, cubic_terms, cubic_terms>;

constexpr std::size_t particles_per_matrix = 16384;

/// Finds frames from mean places, and the square roots of mean squares along all directions.
void find_frames(const Body& body, std::vector<GroupShape>& shapes) {
  const std::vector<std::int32_t>& group = body.grouping->group;
  const auto for_each = [&](const auto& visit) {
    for (std::size_t i = 0; i < group.size(); ++i)
      if (group[i] >= 0) visit(static_cast<std::size_t>(group[i]), body.rest[i]);
  };
  for_each([&](std::size_t g, const Vec3& X) { shapes[g].size += 1, shapes[g].center += X; });
  for (GroupShape& shape : shapes) shape.center /= shape.size;
  std::vector<Mat3> spread(shapes.size(), Mat3::Zero());
  for_each([&](std::size_t g, const Vec3& X) {
    spread[g] += (X - shapes[g].center) * (X - shapes[g].center).transpose();
  });
  for (std::size_t g = 0; g < shapes.size(); ++g)
    shapes[g].frame = inverse_root(spread[g] / shapes[g].size);
  for_each([&](std::size_t g, const Vec3& X) {
    shapes[g].reach = shapes[g].reach.cwiseMax(shapes[g].place_of(X).cwiseAbs());
  });
}

void find_inverses(const Body& body, std::vector<GroupShape>& shapes) {
  const std::vector<std::int32_t>& group = body.grouping->group;
  std::vector<std::vector<Products>> parts((group.size() + particles_per_matrix - 1) /
                                           particles_per_matrix);
  const bool any_cubic = std::any_of(shapes.begin(), shapes.end(),
                                     [](const GroupShape& shape) { return shape.cubic; });
  parallel_for(group.size(), particles_per_matrix, [&](std::size_t begin, std::size_t end) {
    if (!any_cubic) return;
    auto& sums = parts[begin / particles_per_matrix];
    sums.assign(shapes.size(), Products::Zero());
    for (std::size_t i = begin; i < end; ++i) {
      if (group[i] < 0 || !shapes[static_cast<std::size_t>(group[i])].cubic) continue;
      const Terms terms =
          terms_at(shapes[static_cast<std::size_t>(group[i])].place_of(body.rest[i]));
      sums[static_cast<std::size_t>(group[i])] += terms * terms.transpose();
    }
  });
  for (std::size_t g = 0; g < shapes.size(); ++g) {
    GroupShape& shape = shapes[g];
    if (shape.cubic) {
      Products products = Products::Zero();
      for (const auto& sums : parts) products += sums[g];
      shape.inverse = products.inverse();
    } else {
      shape.inverse.diagonal().head<affine_terms>().setConstant(1 / shape.size);
    }
  }
}

}  // namespace

std::vector<GroupShape> group_shapes(const Body& body) {
  const Grouping& grouping = *body.grouping;
  std::vector<GroupShape> shapes(grouping.size());
  for (std::size_t g = 0; g < shapes.size(); ++g) shapes[g].cubic = grouping.cubic[g] != 0;
  find_frames(body, shapes);
  find_inverses(body, shapes);
  return shapes;
}

TangentMotion motion_at(const GroupShape& shape, const GroupMotion& motion, const Vec3& at) {
  if (!shape.cubic)
    return {motion.x.row(0).transpose() + motion.x.middleRows<3>(1).transpose() * at,
            motion.v.row(0).transpose() + motion.v.middleRows<3>(1).transpose() * at,
            motion.x.middleRows<3>(1).transpose(), motion.v.middleRows<3>(1).transpose()};
  const Slopes slopes = slopes_at(at);
  // Too small for Eigen's products of large matrices.
  return {value_at(motion.x, at), value_at(motion.v, at), motion.x.transpose().lazyProduct(slopes),
          motion.v.transpose().lazyProduct(slopes)};
}

}  // namespace sinew
