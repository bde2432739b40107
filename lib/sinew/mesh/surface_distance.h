// SPDX-License-Identifier: GPL-3.0-or-later
// How far points lie from a closed surface, inside or outside of it: nearest faces by a tree of
// boxes, sides by winding numbers.
#pragma once

#include <memory>

#include <sinew/core/triangles.h>
#include <sinew/mesh/surface.h>

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

// How far two surfaces lie apart, whatever their points and triangles are.

struct SurfaceGap {
  double hausdorff = 0;  ///< the farthest that a place on either lies from the other, m
  double mean = 0;       ///< over the area of both, m
};

/// Both are looked at in the corners and the centers of all faces, so that the Hausdorff distance
/// may be short by what happens between them (of two flat pieces nothing, of a face across a fold
/// of the other at most half its longest edge); the mean is Simpson's over each face. In parallel,
/// the same bits for any number of threads. Throws bad input for a surface without an area.
SurfaceGap surface_gap(const Triangles& one, const Triangles& other);

}  // namespace sinew
