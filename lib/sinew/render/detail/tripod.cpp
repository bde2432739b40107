// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/detail/tripod.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <sinew/render/detail/text.h>

namespace sinew {
namespace {

using Vec2 = Eigen::Vector2d;

double distance_to_segment(const Vec2& point, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double part =
      along.isZero(0) ? 0 : std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - a - part * along).norm();
}

/// With round ends and soft edges.
void draw_stroke(Image& image, const Vec2& a, const Vec2& b, double radius, const Color& color) {
  const Vec2 reach = Vec2::Constant(radius + 1);
  const Eigen::Vector2i low = (a.cwiseMin(b) - reach).cast<int>(),
                        high = (a.cwiseMax(b) + reach).cast<int>();
  for (int y = std::max(0, low.y()); y <= std::min(high.y(), image.height - 1); ++y)
    for (int x = std::max(0, low.x()); x <= std::min(high.x(), image.width - 1); ++x) {
      const double away = distance_to_segment(Vec2(x, y), a, b);
      const double coverage = std::clamp(radius + 0.5 - away, 0.0, 1.0);
      std::uint8_t* pixel = image.at(x, y);
      for (int c = 0; c < 3; ++c)
        pixel[c] = static_cast<std::uint8_t>(coverage * color[c] + (1 - coverage) * pixel[c] + 0.5);
    }
}

}  // namespace

int tripod_size(int width, int height) { return std::max(14, std::min(width, height) / 11); }

void draw_tripod(Image& image, const Mat3& view, int x, int y, int size) {
  const Vec2 middle(x + 1.4 * size, y - 1.4 * size);
  TextStyle words;
  words.size = std::max(9, size / 2);
  words.align = Align::center;
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return view(2, a) < view(2, b); });
  for (const int axis : order) {
    const Vec2 along = size * Vec2(view(0, axis), -view(1, axis));
    draw_stroke(image, middle, middle + along, std::max(1.0, size / 18.0), palette::axes[axis]);
    words.color = palette::axes[axis];
    const Vec2 beyond = middle + (1 + 0.6 * words.size / std::max(1.0, along.norm())) * along;
    write_text(image, std::string(1, "XYZ"[axis]), static_cast<int>(std::lround(beyond.x())),
               static_cast<int>(std::lround(beyond.y() - 0.62 * words.size)), words);
  }
}

}  // namespace sinew
