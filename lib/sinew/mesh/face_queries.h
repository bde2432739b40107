// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest place on any set of triangles, open or closed, by CGAL's tree of boxes.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include <sinew/core/triangles.h>

namespace sinew {

struct NearestOnFaces {
  Vec3 place;        ///< on the surface, m
  std::size_t face;  ///< that it lies on; one of several where they meet
};

class NearestFace {
 public:
  /// Faces without area are left out. Throws bad input where none is left.
  explicit NearestFace(const Triangles& surface);
  ~NearestFace();
  NearestFace(NearestFace&&) noexcept;
  NearestFace& operator=(NearestFace&&) noexcept;

  /// Rounded, not exact. From many threads at once if wanted.
  NearestOnFaces to(const Vec3& point) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

// How thin a body is, by rays from its faces to the other side.

/// The thickness (m) below which 1 % of the skin lies. From 2,000 places spread evenly over the
/// area (fewer where most faces are needles) a ray goes inward, across the face, until it has left
/// all parts of the body it came through; places within another part are no skin. Nothing where
/// fewer than half of the rays find an end: a sheet has no inside.
std::optional<double> thinnest_part(const Triangles& surface);

}  // namespace sinew
