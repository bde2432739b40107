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
    for_each_cell(center, [&](std::size_t cell, double, double farthest) {
      if (farthest > radius_ * radius_) return;
      const double reach = center.z() + std::sqrt(radius_ * radius_ - farthest);
      reach_[cell] = std::max(reach_[cell], static_cast<float>(reach));
    });
  }

  bool hides(const Vec3& center) const {
    const double margin = 1e-3 * radius_;  // rounding, here and where it is drawn
    bool hidden = true;
    for_each_cell(center, [&](std::size_t cell, double nearest, double) {
      if (nearest < radius_ * radius_ &&
          reach_[cell] < center.z() + std::sqrt(radius_ * radius_ - nearest) + margin)
        hidden = false;
    });
    return hidden;
  }

 private:
  /// Calls visit(cell, least and largest squared distance of the cell from the center).
  template <class Visit>
  void for_each_cell(const Vec3& center, const Visit& visit) const {
    const Vec3 at = center - low_;
    const auto cell = [&](double meters, std::size_t count) {
      return std::min(static_cast<std::size_t>(std::max(0.0, meters / edge_)), count - 1);
    };
    const auto away = [&](std::size_t index, double place) {
      const double from = static_cast<double>(index) * edge_ - place, to = from + edge_;
      const double nearest = std::max({from, -to, 0.0}), farthest = std::max(-from, to);
      return std::array<double, 2>{nearest * nearest, farthest * farthest};
    };
    const std::size_t right = cell(at.x() + radius_, wide_), top = cell(at.y() + radius_, high_);
    for (std::size_t y = cell(at.y() - radius_, high_); y <= top; ++y) {
      const auto along_y = away(y, at.y());
      for (std::size_t x = cell(at.x() - radius_, wide_); x <= right; ++x) {
        const auto along_x = away(x, at.x());
        visit(y * wide_ + x, along_x[0] + along_y[0], along_x[1] + along_y[1]);
      }
    }
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
