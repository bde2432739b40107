// SPDX-License-Identifier: GPL-3.0-or-later
// The soft shadow that a body throws straight down on what lies below it.
//
//     const GroundShadow shadow(snapshot.particles, snapshot.radius);
//     const double darkness = shadow.at(point_on_the_ground);
#pragma once

#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

class GroundShadow {
 public:
  /// The shadow of spheres of `radius` (m) at these points (n x 3, m).
  GroundShadow(const Points& centers, double radius);

  /// How much of the light from above is hidden at a place: 0 .. 1; 0 above the body.
  double at(const Vec3& place) const;

 private:
  double mean_around(double x, double y, int reach) const;

  Vec3 low_ = Vec3::Zero();
  double edge_ = 1, bottom_ = 0, size_ = 1;
  int wide_ = 0, high_ = 0;
  std::vector<double> sums_;  ///< sums of the covered cells to the lower left of each corner
};

}  // namespace sinew
