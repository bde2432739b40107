// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/cap_tree.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <sinew/core/parallel.h>

namespace sinew {

namespace {

constexpr int caps_in_a_leaf = 4;
constexpr std::size_t nodes_at_a_time = 256;

double integer_power(double x, int exponent) {
  double result = 1;
  for (int i = 0; i < exponent; ++i) result *= x;
  return result;
}

/// Exact for polynomials of degree 5 on a triangle (Radon 1948): weights, and barycentric
/// coordinates of which two are equal.
struct QuadraturePoint {
  double weight, one, two;
};
std::array<QuadraturePoint, 3> radon_points() {
  const double root = std::sqrt(15.0);
  return {{{9.0 / 40, 1.0 / 3, 1.0 / 3},
           {(155 - root) / 1200, (9 + 2 * root) / 21, (6 - root) / 21},
           {(155 + root) / 1200, (9 - 2 * root) / 21, (6 + root) / 21}}};
}

/// The integral of the derivative of the regular harmonics along the normal.
template <int top>
void add_moments(const CapCorners& t, const Vec3& center, Harmonics<top>& sum) {
  static const auto points = radon_points();
  const Vec3 area = (t[1] - t[0]).cross(t[2] - t[0]) / 2;
  Harmonics<top> mean;
  for (const auto& [weight, one, two] : points)
    for (int corner = 0; corner < (one == two ? 1 : 3); ++corner) {
      const Vec3 at = one * t[corner] + two * (t[(corner + 1) % 3] + t[(corner + 2) % 3]);
      mean.add(weight, regular_harmonics<top>(at - center));
    }
  sum.add(1, derivative_along(area, mean));
}

}  // namespace

CapTree::CapTree(std::span<const CapCorners> caps) : order_(caps.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (caps.empty()) return;
  Points middles;
  for (const CapCorners& t : caps) middles.push_back((t[0] + t[1] + t[2]) / 3);
  build(0, static_cast<int>(caps.size()), middles);
  expansions_.resize(nodes_.size());
  parallel_for(nodes_.size(), nodes_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      enclose(nodes_[i], caps);
      expand(i, caps);
    }
  });
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    const Node& node = nodes_[i];
    if (node.left < 0) continue;
    for (const int child : {node.left, node.right})
      expansions_[i].moments.add(
          1, shifted_moments(expansions_[child].moments, nodes_[child].center - node.center));
  }
}

/// Halves by the order of the centers along the longest side of their box; ties by index.
int CapTree::build(int first, int last, const Points& middles) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back({Vec3::Zero(), 0, first, last, -1, -1});
  if (last - first <= caps_in_a_leaf) return index;
  Box box;
  for (int i = first; i < last; ++i) box.extend(middles[order_[i]]);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const int half = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + last,
                   [axis, &middles](int a, int b) {
                     const double at = middles[a][axis], bt = middles[b][axis];
                     return at < bt || (at == bt && a < b);
                   });
  const int left = build(first, half, middles), right = build(half, last, middles);
  nodes_[index].left = left;
  nodes_[index].right = right;
  return index;
}

void CapTree::enclose(Node& node, std::span<const CapCorners> caps) const {
  Box box;
  for (int i = node.first; i < node.last; ++i)
    for (const Vec3& corner : caps[order_[i]]) box.extend(corner);
  node.center = box.center();
  double square = 0;
  for (int i = node.first; i < node.last; ++i)
    for (const Vec3& corner : caps[order_[i]])
      square = std::max(square, (corner - node.center).squaredNorm());
  node.reach = std::sqrt(square);
}

/// Moments of leaves, and all nodes' spread: the mean of a convex function over a triangle is at
/// most that at its corners.
void CapTree::expand(std::size_t index, std::span<const CapCorners> caps) {
  const Node& node = nodes_[index];
  Expansion& expansion = expansions_[index];
  for (int i = node.first; i < node.last; ++i) {
    const CapCorners& t = caps[order_[i]];
    double sum = 0;
    for (const Vec3& corner : t) sum += integer_power((corner - node.center).norm(), degree);
    expansion.spread += (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2 * sum / 3;
    if (node.left < 0) add_moments(t, node.center, expansion.moments);
  }
}

void CapTree::add(const Node& node, const Vec3& eye, FarField& sum) const {
  const Expansion& expansion = expansions_[&node - nodes_.data()];
  const Vec3 to = eye - node.center;
  const double square = to.squaredNorm(), distance = std::sqrt(square);
  const double x = node.reach / distance;
  sum.winding -= field_of(expansion.moments, to) / (4 * pi);
  sum.doubt += expansion.spread * (degree + 1 - degree * x) /
               (4 * pi * integer_power(distance, degree + 2) * (1 - x) * (1 - x));
  sum.clearance = std::min(sum.clearance, distance - node.reach);
}

}  // namespace sinew
