// SPDX-License-Identifier: GPL-3.0-or-later
// A canvas of pictures and what is written and drawn beside them: as pixels, or as SVG, in which
// the pictures are embedded and all else stays sharp at any size.
//
//     Canvas canvas(1280, 720, palette::paper);
//     canvas.add(picture, 20, 20);
//     canvas.write("t = 1 s", 20, 680, {.size = 20});
//     write_png(canvas.pixels(), "bent.png");
#pragma once

#include <string>
#include <variant>
#include <vector>

#include <sinew/render/image.h>

namespace sinew {

enum class Align { left, center, right };

struct TextStyle {
  int size = 20;  ///< size of the font, pixels
  Color color = palette::ink;
  Align align = Align::left;
};

/// Height of one line, pixels.
int line_height(const TextStyle& style);

/// All places in pixels from the upper left corner; what reaches beyond the page is cut off.
class Canvas {
 public:
  Canvas(int width, int height, const Color& background);

  int width() const { return width_; }
  int height() const { return height_; }

  void add(Image picture, int x, int y);
  /// Writes the lines of `text` (UTF-8) downward from y; x is their left end, middle or right end.
  void write(std::string text, int x, int y, const TextStyle& style);
  void fill(int x, int y, int width, int height, const Color& color);
  /// All colors of the map, the lowest at the left.
  void fill(int x, int y, int width, int height, ColorMap map);
  void disc(double x, double y, double radius, const Color& color);
  /// A line with round ends, twice `radius` wide.
  void stroke(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double radius,
              const Color& color);

  Image pixels() const;
  /// `millimeters`: width of the page in print, or 0 for one that fits where it is shown.
  std::string svg(double millimeters) const;

 private:
  struct Picture {
    Image image;
    int x, y;
  };
  struct Words {
    std::string text;
    int x, y;
    TextStyle style;
  };
  struct Bar {
    int x, y, width, height;
    std::variant<Color, ColorMap> color;
  };
  struct Stroke {  // a disc where both ends are the same
    Eigen::Vector2d from, to;
    double radius;
    Color color;
  };

  static void put(Image& page, const Picture& picture);
  static void put(Image& page, const Words& words);
  static void put(Image& page, const Bar& bar);
  static void put(Image& page, const Stroke& stroke);
  static std::string markup(const Picture& picture);
  static std::string markup(const Words& words);
  static std::string markup(const Bar& bar);
  static std::string markup(const Stroke& stroke);

  int width_, height_;
  Color background_;
  std::vector<std::variant<Picture, Words, Bar, Stroke>> items_;
};

}  // namespace sinew
