// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/detail/keys.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/text.h>

namespace sinew {

int color_bar_height(const TextStyle& style) { return 3 * line_height(style); }

namespace {

/// Three digits, of thousands without an exponent.
std::string number_on_bar(double value) {
  const double size = std::abs(value);
  if (!(size >= 1e3 && size < 1e6)) return three_digits(value);
  const double step = std::pow(10, std::floor(std::log10(size)) - 2);
  return std::to_string(std::llround(std::round(value / step) * step));
}

void draw_names(Canvas& page, const ColorScale& scale, int x, int y, int width, TextStyle words) {
  const int line = line_height(words), thick = 3 * line / 4;
  const auto count = static_cast<int>(scale.names.size());
  for (int k = 0; k < count; ++k) {
    const int from = x + k * width / count, to = x + (k + 1) * width / count;
    page.fill(from, y, to - from, thick, scale.color(k));
    page.write(scale.names[static_cast<std::size_t>(k)], (from + to) / 2, y + thick + 2, words);
  }
}

void draw_values(Canvas& page, const ColorScale& scale, int x, int y, int width, TextStyle words) {
  const int line = line_height(words), thick = 3 * line / 4;
  page.fill(x, y, width, thick, scale.map);
  for (const double part : {0.0, 0.5, 1.0}) {
    const double value = scale.low + part * (scale.high - scale.low);
    words.align = part == 0 ? Align::left : part == 1 ? Align::right : Align::center;
    page.write(number_on_bar(value), x + static_cast<int>(part * width), y + thick + 2, words);
  }
}

}  // namespace

void draw_color_bar(Canvas& page, const ColorScale& scale, int x, int y, int width,
                    const TextStyle& style) {
  TextStyle words = style;
  words.align = Align::center;
  const std::string unit = scale.unit.empty() ? "" : " (" + scale.unit + ")";
  page.write(scale.name + unit + scale.note, x + width / 2, y, words);
  const auto draw = scale.names.empty() ? draw_values : draw_names;
  draw(page, scale, x, y + line_height(style), width, words);
}

int tripod_size(int width, int height) { return std::max(14, std::min(width, height) / 11); }

void draw_tripod(Canvas& page, const Mat3& view, int x, int y, int size) {
  const Eigen::Vector2d middle(x + 1.4 * size, y - 1.4 * size);
  TextStyle words;
  words.size = std::max(9, size / 2);
  words.align = Align::center;
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return view(2, a) < view(2, b); });
  for (const int axis : order) {
    const Eigen::Vector2d along = size * Eigen::Vector2d(view(0, axis), -view(1, axis));
    page.stroke(middle, middle + along, std::max(1.0, size / 18.0), palette::axes[axis]);
    words.color = palette::axes[axis];
    const Eigen::Vector2d beyond =
        middle + (1 + 0.6 * words.size / std::max(1.0, along.norm())) * along;
    page.write(std::string(1, "XYZ"[axis]), static_cast<int>(std::lround(beyond.x())),
               static_cast<int>(std::lround(beyond.y() - 0.62 * words.size)), words);
  }
}

}  // namespace sinew
