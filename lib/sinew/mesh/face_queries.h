// SPDX-License-Identifier: GPL-3.0-or-later
// Queries on any set of triangles, open or closed: the nearest point, by CGAL's AABB tree, and the
// thickness of the body, by rays.
//
//     const NearestOnFaces nearest = NearestFace(surface).to(point);
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <sinew/core/triangles.h>

namespace sinew {

struct NearestOnFaces {
  Vec3 place;        ///< on the surface, m
  std::size_t face;  ///< face that contains it; one of several where they meet
};

class NearestFace {
 public:
  /// Faces without area are left out. Throws bad input where none is left.
  explicit NearestFace(const Triangles& surface);
  ~NearestFace();
  NearestFace(NearestFace&&) noexcept;
  NearestFace& operator=(NearestFace&&) noexcept;

  /// Rounded, not exact. May be called from many threads at once.
  NearestOnFaces to(const Vec3& point) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// The 1st percentile of the body's thickness over its skin, m. From 2,000 points spread evenly
/// over the area (fewer where most faces are needles) a ray is cast inward, normal to the face, up
/// to where it has left all parts of the body on its path; points inside another part are not skin.
/// Nothing where fewer than half of the rays leave: a sheet has no inside.
std::optional<double> thinnest_part(const Triangles& surface);

/// Per face, whether its corners lie on one line: exact, by CGAL's predicates.
std::vector<bool> flat_faces(const Triangles& surface);

}  // namespace sinew
