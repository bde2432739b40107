// SPDX-License-Identifier: GPL-3.0-or-later
// The winding number of a closed surface about a point: the signed crossings of a ray from it.
//
//     const bool inside = Winding(faces).around(point).value_or(0) > 0;
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/mesh/surface.h>

namespace sinew {

using Corners = std::array<Vec3, 3>;

/// Triangles in a tree of boxes. Two that share an edge decide alike on which side a ray passes it,
/// in spite of rounding: closed surfaces have no gaps.
class Winding {
 public:
  explicit Winding(std::vector<Corners> faces);

  /// 1 inside an outward surface, 0 outside of it, -1 inside an inward one; nothing for points
  /// closer to the surface than 1e-10 of its size.
  std::optional<int> around(const Vec3& point) const;

 private:
  struct Node {
    Box box;
    int begin, end;  ///< range of its faces
    int second = 0;  ///< its second child, the first follows it; 0: no children
  };

  int build(int begin, int end);
  bool visit(const Node& node, const Vec3& point, int& sum) const;

  std::vector<Corners> faces_;  ///< rotated, so that few lie along the rays
  std::vector<Node> nodes_;
  double near_ = 0;
};

/// Returns the winding of a surface with its caps.
Winding winding_of(const Surface& surface);

}  // namespace sinew
