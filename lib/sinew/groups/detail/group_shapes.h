// SPDX-License-Identifier: GPL-3.0-or-later
// Groups at rest: the frame in which a group is about 1 large in each direction, and what sums over
// its particles need there. And groups in motion: polynomials of the place in that frame.
//
//     const std::vector<GroupShape> shapes = group_shapes(body);
//     const TangentMotion local = motion_at(shapes[g], motion, shapes[g].place_of(X));
#pragma once

#include <Eigen/Core>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/groups/cubic/inner_forces.h>
#include <sinew/groups/cubic/polynomials.h>
#include <sinew/kernel/kernel.h>

namespace sinew {

struct Body;

struct GroupShape {
  Vec3 center = Vec3::Zero();  ///< m
  double size = 0;             ///< particles
  Mat3 frame = Mat3::Zero();   ///< 1/m
  Vec3 reach = Vec3::Zero();   ///< max size of places in the frame, by axis
  bool cubic = false;
  /// Inverse of the sum of the products of terms over the particles.
  Eigen::Matrix<double, cubic_terms, cubic_terms> inverse =
      Eigen::Matrix<double, cubic_terms, cubic_terms>::Zero();

  /// Place in the frame of a particle that is at X (m) at rest.
  Vec3 place_of(const Vec3& X) const { return frame * (X - center); }
  kernel::Motions motions() const { return cubic ? kernel::cubic : kernel::affine; }
  int terms() const { return cubic ? cubic_terms : affine_terms; }
};

/// The shapes of the body's groups, in their order. In parallel.
std::vector<GroupShape> group_shapes(const Body& body);

/// Motion at a place in a group: derivatives along the axes of its frame, a column each.
struct TangentMotion {
  Vec3 x, v;
  Mat3 dx, dv;
};

/// `at`: in the frame.
TangentMotion motion_at(const GroupShape& shape, const GroupMotion& motion, const Vec3& at);

}  // namespace sinew
