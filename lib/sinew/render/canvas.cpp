// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/canvas.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include <sinew/core/base64.h>
#include <sinew/core/text.h>
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

std::string hex_of(const Color& color) {
  static constexpr const char* digits = "0123456789abcdef";
  std::string text = "#";
  for (const std::uint8_t part : color) (text += digits[part / 16]) += digits[part % 16];
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

/// name="value" of an element, with numbers as short as they are.
class Element {
 public:
  explicit Element(const char* name) : text_(std::string("<") + name) {}

  Element& set(const char* name, const std::string& value) {
    text_ += std::string(" ") + name + "=\"" + value + '"';
    return *this;
  }
  Element& set(const char* name, double value) {
    return set(name, number_text(std::round(100 * value) / 100));
  }
  std::string end() const { return text_ + "/>\n"; }
  std::string around(const std::string& content, const char* name) const {
    return text_ + '>' + content + "</" + name + ">\n";
  }

 private:
  std::string text_;
};

Element rectangle(int x, int y, int width, int height) {
  return Element("rect").set("x", x).set("y", y).set("width", width).set("height", height);
}

/// The colors of a map as a gradient of that name.
std::string gradient(ColorMap map, const std::string& name) {
  constexpr int stops = 32;
  std::string colors;
  for (int k = 0; k <= stops; ++k) {
    const double part = k / static_cast<double>(stops);
    colors += Element("stop")
                  .set("offset", number_text(part))
                  .set("stop-color", hex_of(mapped_color(part, map)))
                  .end();
  }
  return Element("linearGradient").set("id", name).around(colors, "linearGradient");
}

std::string lines_of(const std::string& text, int x, int y, const TextStyle& style) {
  static constexpr std::array<const char*, 3> anchors = {"start", "middle", "end"};
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line); y += line_height(style))
    out += Element("text")
               .set("x", x)
               .set("y", y + style.size)
               .set("font-size", style.size)
               .set("text-anchor", anchors[static_cast<std::size_t>(style.align)])
               .set("fill", hex_of(style.color))
               .around(escaped(line), "text");
  return out;
}

}  // namespace

int line_height(const TextStyle& style) { return static_cast<int>(std::lround(1.35 * style.size)); }

Canvas::Canvas(int width, int height, const Color& background)
    : width_(width), height_(height), background_(background) {}

void Canvas::add(Image picture, int x, int y) {
  items_.push_back(Picture{std::move(picture), x, y});
}

void Canvas::write(std::string text, int x, int y, const TextStyle& style) {
  if (!text.empty()) items_.push_back(Words{std::move(text), x, y, style});
}

void Canvas::fill(int x, int y, int width, int height, const Color& color) {
  items_.push_back(Bar{x, y, width, height, color});
}

void Canvas::fill(int x, int y, int width, int height, ColorMap map) {
  items_.push_back(Bar{x, y, width, height, map});
}

void Canvas::disc(double x, double y, double radius, const Color& color) {
  items_.push_back(Stroke{{x, y}, {x, y}, radius, color});
}

void Canvas::stroke(const Vec2& from, const Vec2& to, double radius, const Color& color) {
  items_.push_back(Stroke{from, to, radius, color});
}

void Canvas::put(Image& page, const Picture& picture) {
  paste(page, picture.image, picture.x, picture.y);
}

void Canvas::put(Image& page, const Words& words) {
  write_text(page, words.text, words.x, words.y, words.style);
}

void Canvas::put(Image& page, const Bar& bar) {
  if (const auto* color = std::get_if<Color>(&bar.color))
    return sinew::fill(page, bar.x, bar.y, bar.width, bar.height, *color);
  const ColorMap map = std::get<ColorMap>(bar.color);
  for (int i = 0; i < bar.width; ++i)
    sinew::fill(page, bar.x + i, bar.y, 1, bar.height,
                mapped_color(i / std::max(1.0, bar.width - 1.0), map));
}

/// With soft edges.
void Canvas::put(Image& page, const Stroke& stroke) {
  const auto& [a, b, radius, color] = stroke;
  const Vec2 reach = Vec2::Constant(radius + 1);
  const Eigen::Vector2i low = (a.cwiseMin(b) - reach).cast<int>(),
                        high = (a.cwiseMax(b) + reach).cast<int>();
  for (int y = std::max(0, low.y()); y <= std::min(high.y(), page.height - 1); ++y)
    for (int x = std::max(0, low.x()); x <= std::min(high.x(), page.width - 1); ++x) {
      const double away = distance_to_segment(Vec2(x, y), a, b);
      const double coverage = std::clamp(radius + 0.5 - away, 0.0, 1.0);
      std::uint8_t* pixel = page.at(x, y);
      for (std::size_t c = 0; c < 3; ++c)
        pixel[c] =
            static_cast<std::uint8_t>(std::lround(coverage * color[c] + (1 - coverage) * pixel[c]));
    }
}

Image Canvas::pixels() const {
  Image page(width_, height_, background_);
  for (const auto& item : items_) std::visit([&](const auto& one) { put(page, one); }, item);
  return page;
}

std::string Canvas::markup(const Picture& picture) {
  return Element("image")
      .set("x", picture.x)
      .set("y", picture.y)
      .set("width", picture.image.width)
      .set("height", picture.image.height)
      .set("href", "data:image/png;base64," + base64(png_of(picture.image)))
      .end();
}

std::string Canvas::markup(const Words& words) {
  return lines_of(words.text, words.x, words.y, words.style);
}

/// Gradients are named by their place: several pages may stand in one document.
std::string Canvas::markup(const Bar& bar) {
  const auto& [x, y, width, height, color] = bar;
  const Element area = rectangle(x, y, width, height);
  if (const auto* plain = std::get_if<Color>(&color))
    return Element(area).set("fill", hex_of(*plain)).end();
  const std::string name = "colors" + std::to_string(x) + '_' + std::to_string(y);
  return gradient(std::get<ColorMap>(color), name) +
         Element(area).set("fill", "url(#" + name + ')').end();
}

std::string Canvas::markup(const Stroke& stroke) {
  return Element("line")
      .set("x1", stroke.from.x())
      .set("y1", stroke.from.y())
      .set("x2", stroke.to.x())
      .set("y2", stroke.to.y())
      .set("stroke", hex_of(stroke.color))
      .set("stroke-width", 2 * stroke.radius)
      .set("stroke-linecap", "round")
      .end();
}

std::string Canvas::svg(double millimeters) const {
  std::string content = rectangle(0, 0, width_, height_).set("fill", hex_of(background_)).end();
  for (const auto& item : items_)
    content += std::visit([](const auto& one) { return markup(one); }, item);
  Element page("svg");
  page.set("xmlns", "http://www.w3.org/2000/svg")
      .set("viewBox", "0 0 " + std::to_string(width_) + ' ' + std::to_string(height_))
      .set("font-family", "Arial, Helvetica, Liberation Sans, sans-serif");
  if (millimeters > 0)
    page.set("width", number_text(millimeters) + "mm")
        .set("height", number_text(std::round(100 * millimeters * height_ / width_) / 100) + "mm");
  return page.around('\n' + content, "svg");
}

}  // namespace sinew
