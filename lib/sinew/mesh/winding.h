// SPDX-License-Identifier: GPL-3.0-or-later
// How often a closed surface goes around a point: the signed crossings of a ray from it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

using Corners = std::array<Vec3, 3>;

/// Triangles in a tree of boxes. Two that share an edge see a ray on the same side of it, whatever
/// rounding does: closed surfaces have no gaps.
class Winding {
 public:
  explicit Winding(std::vector<Corners> faces);

  /// 1 within an outward surface, 0 outside of it, -1 within an inward one; nothing closer to the
  /// surface than 1e-10 of its size.
  std::optional<int> around(const Vec3& point) const;

 private:
  struct Node {
    Box box;
    int begin, end;  ///< of its faces
    int second = 0;  ///< its second child, the first follows it; 0: no children
  };

  int build(int begin, int end);
  bool visit(const Node& node, const Vec3& point, int& sum) const;

  std::vector<Corners> faces_;  ///< turned, so that few lie along the rays
  std::vector<Node> nodes_;
  double near_ = 0;
};

}  // namespace sinew
