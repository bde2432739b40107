// SPDX-License-Identifier: GPL-3.0-or-later
// How far points lie from a closed surface, inside or outside of it: nearest faces by a tree of
// boxes, sides by winding numbers.
#pragma once

#include <memory>

#include "mesh/surface.h"

namespace sinew {

/// The nearest point of a surface.
struct NearestPlace {
  double distance = 0;  ///< m, negative inside
  Vec3 normal;          ///< outward, unit: the distance's gradient; on the surface a face's normal
};

class SurfaceDistance {
 public:
  /// Throws bad input for a surface with holes, or without faces that have an area.
  explicit SurfaceDistance(const Surface& surface);
  ~SurfaceDistance();
  SurfaceDistance(SurfaceDistance&&) noexcept;
  SurfaceDistance& operator=(SurfaceDistance&&) noexcept;

  /// From many threads at once if wanted.
  NearestPlace from(const Vec3& point) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace sinew
