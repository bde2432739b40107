// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/detail/ground_shadow.h>

#include <algorithm>
#include <cmath>

namespace sinew {
namespace {

constexpr double cells_along = 96;  // number of cells along the body's longest side
constexpr double softest = 0.12;  // fraction of that side: half the width of the blur at the ground
constexpr double blur_per_height = 0.5;  // it grows with the distance from the body

}  // namespace

GroundShadow::GroundShadow(const Points& centers, double radius) {
  if (centers.empty()) return;
  Box box;
  for (const Vec3& center : centers) box.extend(center);
  const Vec3 reach = Vec3::Constant(radius);
  box = Box(box.min() - reach, box.max() + reach);
  size_ = std::max(box.sizes().maxCoeff(), 1e-12);
  edge_ = size_ / cells_along;
  low_ = box.min();
  bottom_ = low_.z();
  wide_ = 1 + static_cast<int>(box.sizes().x() / edge_);
  high_ = 1 + static_cast<int>(box.sizes().y() / edge_);
  const auto corner = [&](int x, int y) -> double& {
    return sums_[static_cast<std::size_t>(y) * (wide_ + 1) + x];
  };
  sums_.assign(static_cast<std::size_t>(wide_ + 1) * (high_ + 1), 0);
  const int around = static_cast<int>(radius / edge_);
  for (const Vec3& center : centers) {
    const int x = static_cast<int>((center.x() - low_.x()) / edge_),
              y = static_cast<int>((center.y() - low_.y()) / edge_);
    for (int v = std::max(0, y - around); v <= std::min(high_ - 1, y + around); ++v)
      for (int u = std::max(0, x - around); u <= std::min(wide_ - 1, x + around); ++u)
        corner(u + 1, v + 1) = 1;
  }
  for (int y = 1; y <= high_; ++y)
    for (int x = 1; x <= wide_; ++x)
      corner(x, y) += corner(x - 1, y) + corner(x, y - 1) - corner(x - 1, y - 1);
}

double GroundShadow::mean_around(double x, double y, int reach) const {
  const auto clamped = [](double cell, int count) {
    return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(count)));
  };
  const double u = std::floor((x - low_.x()) / edge_), v = std::floor((y - low_.y()) / edge_);
  const std::size_t left = clamped(u - reach, wide_), right = clamped(u + reach + 1, wide_),
                    near = clamped(v - reach, high_), far = clamped(v + reach + 1, high_);
  const auto sum = [&](std::size_t column, std::size_t row) {
    return sums_[row * static_cast<std::size_t>(wide_ + 1) + column];
  };
  const double side = 2 * reach + 1;
  return (sum(right, far) - sum(left, far) - sum(right, near) + sum(left, near)) / (side * side);
}

double GroundShadow::at(const Vec3& place) const {
  if (sums_.empty() || place.z() > bottom_ + 2 * edge_) return 0;
  const double height = std::max(0.0, bottom_ - place.z());
  const double blur = softest * size_ + blur_per_height * height;
  double darkness = 0;  // mean of three widths: its edge is soft
  for (const double part : {0.25, 0.6, 1.0})
    darkness += mean_around(place.x(), place.y(), static_cast<int>(part * blur / edge_)) / 3;
  return darkness / (1 + 2 * height / size_);
}

}  // namespace sinew
