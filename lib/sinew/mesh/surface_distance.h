// SPDX-License-Identifier: GPL-3.0-or-later
// The signed distance of points from a closed surface, by an AABB tree and winding numbers.
//
//     const double depth = -SurfaceDistance(surface).from(point).distance;
#pragma once

#include <memory>

#include <sinew/core/triangles.h>
#include <sinew/mesh/surface.h>

namespace sinew {

/// The nearest point of a surface.
struct NearestPlace {
  double distance = 0;  ///< m, negative inside
  Vec3 normal;          ///< outward, unit: the distance's gradient, or on the surface a face normal
};

class SurfaceDistance {
 public:
  /// Throws bad input for a surface with holes, or without faces that have an area.
  explicit SurfaceDistance(const Surface& surface);
  ~SurfaceDistance();
  SurfaceDistance(SurfaceDistance&&) noexcept;
  SurfaceDistance& operator=(SurfaceDistance&&) noexcept;

  /// May be called from many threads at once.
  NearestPlace from(const Vec3& point) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace sinew
