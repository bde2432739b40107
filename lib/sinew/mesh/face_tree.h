// SPDX-License-Identifier: GPL-3.0-or-later
// The boxes of a surface's faces as a tree, for many searches in a surface that moves: it is built
// in a third of the time of CGAL's AABB tree, and points close to each other share one search. The
// faces are in the order of that tree, and the nearest places are those that it finds, bit by bit.
//
//     const FaceTree tree(surface);
//     tree.find_near(box_of(points), reach, near);
//     const Vec3 place = tree.nearest(points[0], reach, near);
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sinew/core/triangles.h>

namespace sinew {

class FaceTree {
 public:
  /// Faces without area are left out.
  explicit FaceTree(Triangles surface);

  const Triangles& surface() const { return surface_; }
  /// Faces in the order of the tree; none of a surface without area, which has no nearest place.
  const std::vector<std::uint32_t>& faces() const { return order_; }

  /// The distance of a point, m, if it is below `bound`; `bound` otherwise.
  double distance(const Vec3& point, double bound) const;

  /// Faces that may be near, as places in the order.
  struct Candidates {
    std::vector<std::uint32_t> face;
    std::vector<double> squared;  ///< for nearest(): distances, m^2
  };
  /// Fills `found`, in order, with the faces whose boxes are within `reach` (m) of `box`.
  void find_near(const Box& box, double reach, Candidates& found) const;

  /// The nearest place of the candidates, which contain all faces within `bound` (m) of the point;
  /// one face is.
  Vec3 nearest(const Vec3& point, double bound, Candidates& candidates) const;

  /// Every pair of faces whose boxes meet, once. Where there are more than `most`, some of them.
  std::vector<std::array<std::uint32_t, 2>> meeting_boxes(std::size_t most) const;

 private:
  struct Face {
    Vec3 a, b, c;
  };
  /// A part of the order, and its box: that of one face, or of a node before those of its halves.
  struct Part {
    std::size_t node, first, count;

    Part left() const { return {node + 1, first, count / 2}; }
    Part right() const { return {node + count / 2, first + count / 2, count - count / 2}; }
  };
  struct Unsorted;
  struct Pairs;

  Part whole() const { return {0, 0, order_.size()}; }
  const Box& box_of(const Part& part) const {
    return part.count == 1 ? boxes_[part.first] : nodes_[part.node];
  }
  double squared_distance(const Part& part, const Box& box) const;
  void expand(const Part& part, std::vector<Unsorted>& faces, const std::vector<Box>& boxes);
  void approach(const Part& part, const Box& point, double& squared) const;
  void find_near(const Part& part, const Box& box, double squared_reach,
                 std::vector<std::uint32_t>& found) const;

  Triangles surface_;
  std::vector<std::uint32_t> order_;
  std::vector<Face> sorted_;
  std::vector<Box> boxes_;  ///< boxes of the faces in order
  std::vector<Box> nodes_;
  double rounding_ = 0;  ///< rounding of distances, m
};

}  // namespace sinew
