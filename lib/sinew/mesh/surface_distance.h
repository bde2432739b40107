// SPDX-License-Identifier: GPL-3.0-or-later
// The signed distance of points from a closed surface, by an AABB tree and winding numbers, and the
// distance between two surfaces.
//
//     const double depth = -SurfaceDistance(surface).from(point).distance;
//     const double gap = surface_gap(one, other).hausdorff;
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

// The distance between two surfaces of any triangulation.

struct SurfaceGap {
  double hausdorff = 0;  ///< largest distance of a point on either from the other, m
  double mean = 0;       ///< over the area of both, m
};

/// Both are sampled at the corners and centers of all faces, so that the Hausdorff distance may be
/// underestimated between them (not for flat pieces; for a face across a fold of the other by at
/// most half its longest edge); the mean is by Simpson's rule over each face. In parallel, the same
/// bits for any number of threads. Throws bad input for a surface without area.
SurfaceGap surface_gap(const Triangles& one, const Triangles& other);

}  // namespace sinew
