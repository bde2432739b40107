// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/winding.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace sinew {
namespace {

constexpr int leaf_faces = 4;
constexpr double on_surface = 1e-10;

/// Rays run along z of a frame in which faces of usual meshes are oblique.
const Mat3& frame() {
  static const Mat3 turned = Quat(0.7236, 0.3517, -0.4931, 0.2871).normalized().toRotationMatrix();
  return turned;
}

Box box_of(const Corners& face) {
  Box box;
  for (const Vec3& corner : face) box.extend(corner);
  return box;
}

/// 1 where the side from `a` to `b` passes the point on its right upward, -1 downward, else 0.
int pass(const Vec3& a, const Vec3& b, const Vec3& point) {
  const bool up = a.y() <= point.y() && b.y() > point.y();
  const bool down = b.y() <= point.y() && a.y() > point.y();
  if (!up && !down) return 0;
  const Vec3 &low = up ? a : b, &high = up ? b : a;  // the same for both faces of the side
  const double turn =
      (high.x() - low.x()) * (point.y() - low.y()) - (point.x() - low.x()) * (high.y() - low.y());
  return turn > 0 ? (up ? 1 : -1) : 0;
}

/// Signed crossing of the ray along z from the point with the face.
int turns(const Corners& f, const Vec3& point) {
  return pass(f[0], f[1], point) + pass(f[1], f[2], point) + pass(f[2], f[0], point);
}

}  // namespace

Winding::Winding(std::vector<Corners> faces) : faces_(std::move(faces)) {
  for (Corners& face : faces_)
    for (Vec3& corner : face) corner = frame() * corner;
  if (faces_.empty()) return;
  build(0, static_cast<int>(faces_.size()));
  near_ = on_surface * nodes_[0].box.diagonal().norm();
}

int Winding::build(int begin, int end) {
  const int self = static_cast<int>(nodes_.size());
  nodes_.push_back({Box(), begin, end});
  for (int i = begin; i < end; ++i) nodes_[self].box.extend(box_of(faces_[i]));
  if (end - begin <= leaf_faces) return self;
  int axis;
  nodes_[self].box.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(faces_.begin() + begin, faces_.begin() + middle, faces_.begin() + end,
                   [axis](const Corners& f, const Corners& g) {
                     return f[0][axis] + f[1][axis] + f[2][axis] <
                            g[0][axis] + g[1][axis] + g[2][axis];
                   });
  build(begin, middle);
  const int second = build(middle, end);
  nodes_[self].second = second;
  return self;
}

bool Winding::visit(const Node& node, const Vec3& point, int& sum) const {
  const Vec3 &low = node.box.min(), &high = node.box.max();
  if (point.x() < low.x() || point.x() > high.x() || point.y() < low.y() || point.y() > high.y() ||
      point.z() > high.z() + near_)
    return true;
  if (node.second > 0)
    return visit((&node)[1], point, sum) && visit(nodes_[node.second], point, sum);
  for (int i = node.begin; i < node.end; ++i) {
    const Corners& face = faces_[i];
    const int around = turns(face, point);
    if (around == 0) continue;
    const Vec3 normal = (face[1] - face[0]).cross(face[2] - face[0]);
    const double above = normal.dot(face[0] - point);
    if (std::abs(above) <= near_ * normal.norm()) return false;
    if (above * around > 0) sum += around;
  }
  return true;
}

std::optional<int> Winding::around(const Vec3& point) const {
  int sum = 0;
  if (faces_.empty() || visit(nodes_[0], frame() * point, sum)) return sum;
  return std::nullopt;
}

Winding winding_of(const Surface& surface) {
  std::vector<Corners> faces;
  for (const Triangles* part : {&surface.triangles, &surface.caps})
    for (const auto& [a, b, c] : part->faces)
      faces.push_back({part->points[a], part->points[b], part->points[c]});
  return Winding(std::move(faces));
}

}  // namespace sinew
