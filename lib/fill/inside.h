// SPDX-License-Identifier: GPL-3.0-or-later
// Where a point lies against a closed surface, exactly: CGAL's Side_of_triangle_mesh, which counts
// crossings with exact predicates.
#pragma once

#include <memory>

#include "core/triangles.h"

namespace sinew {

enum class Side { outside, boundary, inside };

class InsideTest {
 public:
  /// Builds the search tree. The surface must be closed and free of self-intersections; faces
  /// without area are left out (they change no answer, and rays would get stuck on them).
  explicit InsideTest(const Triangles& surface);
  ~InsideTest();
  InsideTest(const InsideTest&) = delete;  // CGAL's test must stay where it was made
  InsideTest& operator=(const InsideTest&) = delete;

  /// May be called from many threads at once.
  Side side(const Vec3& point) const;

  /// The first face (index into the surface's) above a point inside, along z.
  int face_above(const Vec3& point) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace sinew
