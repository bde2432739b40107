// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/volume/detail/inside_space.h>

#include <algorithm>
#include <cmath>

namespace sinew {
namespace {

constexpr int faces_in_a_leaf = 4;
constexpr double far_away = 3;   // reaches, beyond which faces act together
constexpr double fine = 1e-7;    // fraction of a segment: how exactly bisection finds a crossing
constexpr double beside = 1e-5;  // fraction of a segment: where the sides of a face are looked at
constexpr int rounds_of_faces = 4;  // after which no single face is looked for

Vec3 center_of(const Corners& face) { return (face[0] + face[1] + face[2]) / 3; }

Vec3 area_of(const Corners& face) { return (face[1] - face[0]).cross(face[2] - face[0]) / 2; }

/// Van Oosterom and Strackee 1983.
double solid_angle(const Corners& face, const Vec3& point) {
  const Vec3 a = face[0] - point, b = face[1] - point, c = face[2] - point;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)),
                        la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

SolidAngle::SolidAngle(const Triangles& faces) {
  for (const auto& [a, b, c] : faces.faces)
    faces_.push_back({faces.points[a], faces.points[b], faces.points[c]});
  if (!faces_.empty()) build(0, static_cast<int>(faces_.size()));
}

int SolidAngle::build(int begin, int end) {
  const int self = static_cast<int>(nodes_.size());
  Box box;
  Vec3 area = Vec3::Zero();
  for (int i = begin; i < end; ++i) {
    for (const Vec3& corner : faces_[i]) box.extend(corner);
    area += area_of(faces_[i]);
  }
  nodes_.push_back({begin, end, 0, box.center(), area, box.diagonal().norm() / 2});
  if (end - begin <= faces_in_a_leaf) return self;
  int axis;
  box.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(faces_.begin() + begin, faces_.begin() + middle, faces_.begin() + end,
                   [axis](const Corners& f, const Corners& g) {
                     return center_of(f)[axis] < center_of(g)[axis];
                   });
  build(begin, middle);
  const int second = build(middle, end);
  nodes_[self].second = second;
  return self;
}

double SolidAngle::sum(const Node& node, const Vec3& point) const {
  const Vec3 to = node.center - point;
  const double distance = to.norm();
  if (distance > far_away * node.reach) return node.area.dot(to) / (distance * distance * distance);
  if (node.second > 0) return sum((&node)[1], point) + sum(nodes_[node.second], point);
  double angle = 0;
  for (int i = node.begin; i < node.end; ++i) angle += solid_angle(faces_[i], point);
  return angle;
}

double SolidAngle::at(const Vec3& point) const {
  return nodes_.empty() ? 0 : sum(nodes_[0], point) / (4 * pi);
}

InsideSpace::InsideSpace(const Surface& surface, std::optional<double> thickness)
    : surface_(surface.triangles), nearest_(surface.triangles), winding_(winding_of(surface)) {
  if (!surface.closed()) caps_.emplace(surface.caps);
  if (thickness) half_thickness_ = *thickness / 2;
  nudge_ = Vec3(0.31, 0.47, 0.83) * 1e-8 * bounds(surface_.points).diagonal().norm();
}

bool InsideSpace::contains(const Vec3& point) const {
  if (half_thickness_) return (nearest_.to(point).place - point).norm() < *half_thickness_;
  std::optional<int> around = winding_.around(point);
  if (!caps_) return around.value_or(0) > 0;
  const Vec3 at = around ? point : Vec3(point + nudge_);
  if (!around) around = winding_.around(at);
  return around && *around - caps_->at(at) > 0.5;
}

/// The crossing of the segment with the plane of the nearest face, if the border is there.
std::optional<double> InsideSpace::in_face(const Vec3& from, const Vec3& to, double low,
                                           double high) const {
  const Vec3 along = to - from;
  const std::size_t face = nearest_.to(from + (low + high) / 2 * along).face;
  const auto& corners = surface_.faces[face];
  const Vec3 normal = area_vector(surface_, corners);
  const double slope = normal.dot(along);
  if (slope == 0) return std::nullopt;
  const double at = normal.dot(surface_.points[corners[0]] - from) / slope;
  if (!(at >= low && at <= high)) return std::nullopt;
  const double before = at - beside, after = at + beside;
  if (before > low && !contains(from + before * along)) return std::nullopt;
  if (after < high && contains(from + after * along)) return std::nullopt;
  return at;
}

double InsideSpace::crossing(const Vec3& inside, const Vec3& outside) const {
  double low = 0, high = 1;
  for (int round = 0; high - low > fine; ++round) {
    if (round < rounds_of_faces && !half_thickness_)
      if (const auto at = in_face(inside, outside, low, high)) return *at;
    const double middle = (low + high) / 2;
    (contains(inside + middle * (outside - inside)) ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace sinew
