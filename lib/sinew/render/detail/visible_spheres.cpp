// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/detail/visible_spheres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace sinew {
namespace {

constexpr double cells_per_radius = 6;
constexpr double max_cells = 3e7;
constexpr float nothing = -std::numeric_limits<float>::infinity();

/// How far in front the spheres reach over all of each cell of a plane across the view.
class Front {
 public:
  Front(const Box& box, double radius) : radius_(radius), low_(box.min() - Vec3::Constant(radius)) {
    const Vec3 size = box.sizes() + Vec3::Constant(2 * radius);
    edge_ = std::max(radius / cells_per_radius, std::sqrt(size.x() * size.y() / max_cells));
    wide_ = 1 + static_cast<std::size_t>(size.x() / edge_);
    high_ = 1 + static_cast<std::size_t>(size.y() / edge_);
    reach_.assign(wide_ * high_, nothing);
  }

  void add(const Vec3& center) {
    const Cells cells = cells_of(center);
    for (std::size_t y = 0; y < cells.y.count; ++y)
      for (std::size_t x = 0; x < cells.x.count; ++x) {
        const double farthest = cells.x.farthest[x] + cells.y.farthest[y];
        if (farthest > radius_ * radius_) continue;
        const double reach = center.z() + std::sqrt(radius_ * radius_ - farthest);
        float& here = reach_[cells.place(x, y, wide_)];
        here = std::max(here, static_cast<float>(reach));
      }
  }

  bool hides(const Vec3& center) const {
    const double margin = 1e-3 * radius_;  // rounding, here and where it is drawn
    const Cells cells = cells_of(center);
    for (std::size_t y = 0; y < cells.y.count; ++y)
      for (std::size_t x = 0; x < cells.x.count; ++x) {
        const double nearest = cells.x.nearest[x] + cells.y.nearest[y];
        if (nearest < radius_ * radius_ &&
            reach_[cells.place(x, y, wide_)] <
                center.z() + std::sqrt(radius_ * radius_ - nearest) + margin)
          return false;
      }
    return true;
  }

 private:
  /// Cells that a sphere meets along one direction, with squared distances from its center.
  struct Along {
    std::size_t first = 0, count = 0;
    std::array<double, 2 * static_cast<std::size_t>(cells_per_radius) + 2> nearest, farthest;
  };
  struct Cells {
    Along x, y;
    std::size_t place(std::size_t i, std::size_t j, std::size_t wide) const {
      return (y.first + j) * wide + x.first + i;
    }
  };

  Along along(double place, std::size_t cells) const {
    const auto cell = [&](double meters) {
      return std::min(static_cast<std::size_t>(std::max(0.0, meters / edge_)), cells - 1);
    };
    Along out;
    out.first = cell(place - radius_), out.count = cell(place + radius_) + 1 - out.first;
    for (std::size_t i = 0; i < out.count; ++i) {
      const double from = static_cast<double>(out.first + i) * edge_ - place, to = from + edge_;
      const double nearest = std::max({from, -to, 0.0}), farthest = std::max(-from, to);
      out.nearest[i] = nearest * nearest, out.farthest[i] = farthest * farthest;
    }
    return out;
  }

  Cells cells_of(const Vec3& center) const {
    const Vec3 at = center - low_;
    return {along(at.x(), wide_), along(at.y(), high_)};
  }

  double radius_, edge_ = 1;
  Vec3 low_;
  std::size_t wide_ = 1, high_ = 1;
  std::vector<float> reach_;
};

}  // namespace

std::vector<std::size_t> visible_spheres(const Points& centers, double radius, const Mat3& view) {
  std::vector<std::size_t> visible;
  Points seen;
  Box box;
  seen.reserve(centers.size());
  for (const Vec3& center : centers) box.extend(seen.emplace_back(view * center));
  if (box.isEmpty() || !(radius > 0)) {
    visible.resize(centers.size());
    std::iota(visible.begin(), visible.end(), std::size_t{0});
    return visible;
  }
  Front front(box, radius);
  for (const Vec3& center : seen) front.add(center);
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (!front.hides(seen[i])) visible.push_back(i);
  return visible;
}

}  // namespace sinew
