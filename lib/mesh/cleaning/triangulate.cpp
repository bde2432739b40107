// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cleaning/triangulate.h"

#include <string>

#include "core/error.h"

namespace sinew {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr std::size_t most_corners = 1000;  // cutting ears takes up to corners^3 steps

/// Newell's normal: the mean over all corners, so that a bent polygon has one too.
Vec3 normal_of(const std::vector<int>& polygon, const Points& points) {
  Vec3 normal = Vec3::Zero();
  const Vec3& origin = points[polygon[0]];
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    normal += (points[polygon[i]] - origin).cross(points[polygon[i + 1]] - origin);
  return normal;
}

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 ab = b - a, ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

class EarCutter {
 public:
  EarCutter(const std::vector<int>& polygon, const Points& points) : left_(polygon) {
    const Vec3 normal = normal_of(polygon, points);
    int drop;  // the axis that is most across the polygon
    normal.cwiseAbs().maxCoeff(&drop);
    const int u = (drop + 1) % 3, v = (drop + 2) % 3;
    for (const int corner : polygon) {
      const Vec3& p = points[corner];
      flat_.push_back(normal[drop] < 0 ? Vec2(p[v], p[u]) : Vec2(p[u], p[v]));
    }
  }

  std::vector<std::array<int, 3>> triangles() {
    std::vector<std::array<int, 3>> result;
    while (left_.size() > 3) {
      const std::size_t ear = next_ear();
      result.push_back({left_[before(ear)], left_[ear], left_[after(ear)]});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
      flat_.erase(flat_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    result.push_back({left_[0], left_[1], left_[2]});
    return result;
  }

 private:
  std::size_t before(std::size_t i) const { return i == 0 ? left_.size() - 1 : i - 1; }
  std::size_t after(std::size_t i) const { return i + 1 == left_.size() ? 0 : i + 1; }
  double turn_at(std::size_t i) const { return turn(flat_[before(i)], flat_[i], flat_[after(i)]); }

  std::size_t next_ear() {
    std::vector<std::size_t> blunt;  // corners that may lie in an ear: those that do not turn left
    for (std::size_t i = 0; i < left_.size(); ++i)
      if (turn_at(i) <= 0) blunt.push_back(i);
    if (!blunt.empty() && left_.size() > most_corners)
      throw bad_input("a face that is not convex has " + std::to_string(left_.size()) + " corners",
                      "export the mesh as triangles");
    for (std::size_t i = 0; i < left_.size(); ++i)
      if (turn_at(i) > 0 && empty(i, blunt)) return i;
    return 0;  // crosses itself or has no area: any cut is as good
  }

  bool empty(std::size_t ear, const std::vector<std::size_t>& blunt) const {
    const std::size_t a = before(ear), c = after(ear);
    for (const std::size_t i : blunt) {
      if (i == a || i == c || i == ear) continue;
      if (turn(flat_[a], flat_[ear], flat_[i]) >= 0 && turn(flat_[ear], flat_[c], flat_[i]) >= 0 &&
          turn(flat_[c], flat_[a], flat_[i]) >= 0)
        return false;
    }
    return true;
  }

  std::vector<int> left_;
  std::vector<Vec2> flat_;
};

}  // namespace

std::vector<std::array<int, 3>> triangulate(const std::vector<int>& polygon, const Points& points) {
  if (polygon.size() == 3) return {{polygon[0], polygon[1], polygon[2]}};
  return EarCutter(polygon, points).triangles();
}

}  // namespace sinew
