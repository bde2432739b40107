// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/refine.h>

#include <algorithm>
#include <map>
#include <utility>

#include <sinew/core/text.h>
#include <sinew/mesh/border.h>

namespace sinew {
namespace {

using Face = std::array<int, 3>;

/// Points in the middle of the sides that are too long; both faces of a side get the same one.
class Middles {
 public:
  Middles(Points& points, double longest, std::vector<std::array<int, 2>>* ends)
      : points_(points), squared_(longest * longest), ends_(ends) {}

  /// -1: the side is short enough.
  int between(int a, int b) {
    if ((points_[a] - points_[b]).squaredNorm() <= squared_) return -1;
    const auto [at, added] =
        numbers_.try_emplace(std::minmax(a, b), static_cast<int>(points_.size()));
    if (added) points_.push_back((points_[std::min(a, b)] + points_[std::max(a, b)]) / 2);
    if (added && ends_ != nullptr) ends_->push_back({a, b});
    return at->second;
  }

  /// The points from a to b after all halving.
  std::vector<int> chain(int a, int b) {
    std::vector<int> points{a};
    extend(points, b);
    return points;
  }

  double distance(int a, int b) const { return (points_[a] - points_[b]).norm(); }

 private:
  void extend(std::vector<int>& points, int end) {
    const int middle = between(points.back(), end);
    if (middle < 0) return points.push_back(end);
    extend(points, middle);
    extend(points, end);
  }

  Points& points_;
  double squared_;
  std::vector<std::array<int, 2>>* ends_;
  std::map<std::pair<int, int>, int> numbers_;
};

/// Cuts a face whose first side is halved, and not the last: two or three parts.
void cut(const Face& face, int first, int second, std::vector<Face>& faces) {
  const auto& [a, b, c] = face;
  faces.push_back({a, first, c});
  if (second < 0) return faces.push_back({first, b, c});
  faces.push_back({first, second, c});
  faces.push_back({first, b, second});
}

/// Cuts a face whose first two sides are many times as long as they may be, and whose last is short
/// enough, into faces between the points of both: halving would make many more.
void cut_needle(const Face& face, Middles& middles, std::vector<Face>& faces) {
  const std::vector<int> one = middles.chain(face[1], face[0]),
                         other = middles.chain(face[1], face[2]);
  std::size_t i = 1, j = 1;
  faces.push_back({one[1], face[1], other[1]});
  while (i + 1 < one.size() || j + 1 < other.size()) {
    const bool first =
        j + 1 == other.size() || (i + 1 < one.size() && middles.distance(one[i + 1], other[j]) <=
                                                            middles.distance(one[i], other[j + 1]));
    if (first) {
      faces.push_back({one[i + 1], one[i], other[j]});
      ++i;
    } else {
      faces.push_back({one[i], other[j], other[j + 1]});
      ++j;
    }
  }
}

/// Turned so that its last side is the shortest.
Face turned(Face face, const Middles& middles) {
  const auto side = [&](int k) { return middles.distance(face[k], face[(k + 1) % 3]); };
  while (side(2) > side(0) || side(2) > side(1))
    std::rotate(face.begin(), face.begin() + 1, face.end());
  return face;
}

bool is_needle(const Face& face, const Middles& middles, double longest) {
  constexpr double many = 8;
  const auto& [a, b, c] = face;
  return middles.distance(c, a) <= longest &&
         std::min(middles.distance(a, b), middles.distance(b, c)) > many * longest;
}

void cut(Face face, std::array<int, 3> middle, std::vector<Face>& faces) {
  const auto count = std::count_if(middle.begin(), middle.end(), [](int m) { return m >= 0; });
  if (count == 0) return faces.push_back(face);
  if (count == 3) {
    faces.push_back({face[0], middle[0], middle[2]});
    faces.push_back({middle[0], face[1], middle[1]});
    faces.push_back({middle[2], middle[1], face[2]});
    return faces.push_back(middle);
  }
  while (middle[0] < 0 || middle[2] >= 0) {
    std::rotate(face.begin(), face.begin() + 1, face.end());
    std::rotate(middle.begin(), middle.begin() + 1, middle.end());
  }
  cut(face, middle[0], middle[1], faces);
}

}  // namespace

double longest_side(const Triangles& surface) {
  double longest = 0;
  for (const Face& face : surface.faces)
    for (int i = 0; i < 3; ++i)
      longest =
          std::max(longest, (surface.points[face[i]] - surface.points[face[(i + 1) % 3]]).norm());
  return longest;
}

Triangles refined(Triangles surface, double longest, std::vector<std::array<int, 2>>* ends) {
  Middles middles(surface.points, longest, ends);
  for (bool any = true; any;) {
    any = false;
    std::vector<Face> faces;
    for (const Face& given : surface.faces) {
      const auto& [a, b, c] = given;
      const int ab = middles.between(a, b), bc = middles.between(b, c), ca = middles.between(c, a);
      any = any || ab >= 0 || bc >= 0 || ca >= 0;
      if (const Face face = turned(given, middles); is_needle(face, middles, longest))
        cut_needle(face, middles, faces);
      else
        cut(given, {ab, bc, ca}, faces);
    }
    surface.faces = std::move(faces);
  }
  return surface;
}

Triangles thickened(const Triangles& surface, double thickness) {
  const Points normals = point_normals(surface);
  const int count = static_cast<int>(surface.points.size());
  Triangles layer;
  for (const double side : {thickness / 2, -thickness / 2})
    for (int i = 0; i < count; ++i) layer.points.push_back(surface.points[i] + side * normals[i]);
  for (const auto& [a, b, c] : surface.faces) {
    layer.faces.push_back({a, b, c});
    layer.faces.push_back({count + a, count + c, count + b});
  }
  const std::vector<EdgeUse> uses = edge_uses(surface);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 1) return;
    const int from = edge[0].forward ? edge[0].low : edge[0].high;
    const int to = edge[0].forward ? edge[0].high : edge[0].low;
    layer.faces.push_back({to, from, count + from});
    layer.faces.push_back({to, count + from, count + to});
  });
  return layer;
}

std::string obj_text(const Triangles& surface) {
  std::string text;
  for (const Vec3& p : surface.points)
    text += "v " + number_text(p.x()) + ' ' + number_text(p.y()) + ' ' + number_text(p.z()) + '\n';
  for (const auto& [a, b, c] : surface.faces)
    text += "f " + std::to_string(a + 1) + ' ' + std::to_string(b + 1) + ' ' +
            std::to_string(c + 1) + '\n';
  return text;
}

}  // namespace sinew
