// SPDX-License-Identifier: GPL-3.0-or-later
// The solid angle of many triangles about a point, over 4 pi: their own winding number. Distant
// ones are combined by multipole expansion (as by Barill et al. 2018, to a higher degree).
//
// With triangles dA at distances h from the node's center, at most `reach`, the point at distance d
// from it, and x = reach / d, the terms of degree l > n add up to at most
//   1 / (4 pi) sum over l of integral l h^(l - 1) dA / d^(l + 1)
//     <= integral h^n dA / (4 pi d^(n + 2)) (n + 1 - n x) / (1 - x)^2,
// for |grad of r^l P_l| <= l r^(l - 1), which is Szego's inequality for (P_l of cos).
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/fill/detail/solid_harmonics.h>

namespace sinew {

using CapCorners = std::array<Vec3, 3>;

class CapTree {
 public:
  explicit CapTree(std::span<const CapCorners> caps);

  /// The caps' indices, those of each node one after the other.
  const std::vector<int>& order() const { return order_; }

  struct FarField {
    double winding = 0;
    double doubt = 0;                                            ///< bound on its error
    double clearance = std::numeric_limits<double>::infinity();  ///< no cap is closer
  };

  /// The field of nodes whose distance exceeds `farness` (above 1) times their reach; near(first,
  /// last) is called for the places in the order of all other caps.
  template <class Near>
  FarField far_field(const Vec3& eye, double farness, Near&& near) const {
    std::array<int, 64> waiting;  // the tree is shallower, by halving
    int count = 0;
    FarField sum;
    if (!nodes_.empty()) waiting[count++] = 0;
    while (count > 0) {
      const Node& node = nodes_[waiting[--count]];
      if ((eye - node.center).squaredNorm() > farness * farness * node.reach * node.reach) {
        add(node, eye, sum);
      } else if (node.left < 0) {
        near(node.first, node.last);
      } else {
        waiting[count++] = node.right;
        waiting[count++] = node.left;
      }
    }
    return sum;
  }

 private:
  static constexpr int degree = 5;

  struct Node {
    Vec3 center;
    double reach;  ///< distance of the farthest corner from the center
    int first, last;
    int left, right;  ///< nodes; -1: a leaf
  };
  struct Expansion {
    Harmonics<degree> moments;
    double spread = 0;  ///< bound on the integral of distance^degree
  };

  int build(int first, int last, const Points& middles);
  void enclose(Node& node, std::span<const CapCorners> caps) const;
  void expand(std::size_t index, std::span<const CapCorners> caps);
  void add(const Node& node, const Vec3& eye, FarField& sum) const;

  std::vector<int> order_;
  std::vector<Node> nodes_;  ///< children after their parents
  std::vector<Expansion> expansions_;
};

}  // namespace sinew
