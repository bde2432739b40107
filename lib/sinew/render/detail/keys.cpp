// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/detail/keys.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <sinew/core/text.h>
#include <sinew/render/detail/text.h>

namespace sinew {

int color_bar_height(const TextStyle& style) { return 3 * line_height(style); }

namespace {

/// The unit in which all numbers of a bar are given.
PrefixedUnit unit_of(const ColorScale& scale) {
  return prefixed_unit(std::max(std::abs(scale.low), std::abs(scale.high)), scale.unit);
}

/// Three digits, of thousands without an exponent.
std::string number_on_bar(double value) {
  const double size = std::abs(value);
  if (!(size >= 1e3 && size < 1e6)) return three_digits(value);
  const double step = std::pow(10, std::floor(std::log10(size)) - 2);
  return std::to_string(std::llround(std::round(value / step) * step));
}

std::string title_of(const ColorScale& scale) {
  const std::string unit = scale.unit.empty() ? "" : " (" + unit_of(scale).unit + ")";
  return scale.name + unit + scale.note;
}

/// Numbers at the bar's left end, middle and right end.
std::array<std::string, 3> numbers_of(const ColorScale& scale) {
  const double size = unit_of(scale).size;
  return {number_on_bar(scale.low / size), number_on_bar((scale.low + scale.high) / 2 / size),
          number_on_bar(scale.high / size)};
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
  constexpr std::array<Align, 3> aligned = {Align::left, Align::center, Align::right};
  const std::array<std::string, 3> numbers = numbers_of(scale);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    words.align = aligned[k];
    page.write(numbers[k], x + static_cast<int>(k) * width / 2, y + thick + 2, words);
  }
}

}  // namespace

void draw_color_bar(Canvas& page, const ColorScale& scale, int x, int y, int width,
                    const TextStyle& style) {
  TextStyle words = style;
  words.align = Align::center;
  page.write(title_of(scale), x + width / 2, y, words);
  const auto draw = scale.names.empty() ? draw_values : draw_names;
  draw(page, scale, x, y + line_height(style), width, words);
}

int color_bar_width(const ColorScale& scale, const TextStyle& style) {
  int below = 0;  // with a letter's width between
  if (scale.names.empty())
    for (const std::string& number : numbers_of(scale))
      below += text_width(number, style) + style.size;
  for (const std::string& name : scale.names)
    below = std::max(below,
                     (text_width(name, style) + style.size) * static_cast<int>(scale.names.size()));
  return std::max(below, text_width(title_of(scale), style));
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
