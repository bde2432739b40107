// SPDX-License-Identifier: GPL-3.0-or-later
// Where a point lies against a closed surface, by CGAL's Side_of_triangle_mesh: one exact query per
// point. Slow beside the rows, and independent of them: what the fill is verified with.
#pragma once

#include <memory>

#include "core/triangles.h"

namespace sinew {

enum class Side { outside, boundary, inside };

class SideOf {
 public:
  /// Builds the search tree. The surface must be closed. Faces without area are left out: they
  /// change no answer, and rays would get stuck on them. Where parts of the surface overlap CGAL
  /// counts crossings modulo 2.
  explicit SideOf(const Triangles& surface);
  ~SideOf();
  SideOf(const SideOf&) = delete;  // CGAL's test must stay where it was made
  SideOf& operator=(const SideOf&) = delete;

  /// May be called from many threads at once.
  Side side(const Vec3& point) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace sinew
