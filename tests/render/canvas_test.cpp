// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/canvas.h>

#include <algorithm>
#include <regex>

#include <sinew/core/base64.h>
#include <sinew/core/file.h>
#include <sinew/render/detail/keys.h>
#include <sinew/render/figure.h>
#include "helpers.h"
#include "synthetic_run.h"

namespace sinew::canvas_test {

Color color_at(const Image& image, int x, int y) {
  return {image.at(x, y)[0], image.at(x, y)[1], image.at(x, y)[2]};
}

TEST(Canvas, color_bar_of_names_has_a_part_for_each) {
  const TextStyle style{14};
  Canvas page(200, color_bar_height(style) + 10, palette::paper);
  const ColorScale scale{"material", "", 0, 2, ColorMap::indigo, {"flesh", "fat", "bone"}};
  draw_color_bar(page, scale, 10, 5, 180, style);
  const Image image = page.pixels();
  const int middle = 5 + line_height(style) + line_height(style) / 3;
  for (int part = 0; part < 3; ++part)
    for (const int x : {11 + 60 * part, 40 + 60 * part, 69 + 60 * part})
      EXPECT_EQ(color_at(image, x, middle), scale.color(part)) << x;
}

TEST(Canvas, color_bar_runs_from_low_to_high) {
  Canvas page(200, 80, palette::paper);
  const TextStyle style{16, palette::ink, Align::left};
  draw_color_bar(page, {"speed", "m/s", 0, 2}, 10, 5, 180, style);
  const Image image = page.pixels();
  const int y = 5 + line_height(style) + 4;
  EXPECT_EQ(color_at(image, 10, y), mapped_color(0));
  EXPECT_EQ(color_at(image, 189, y), mapped_color(1));
}

TEST(Canvas, discs_and_strokes_are_round) {
  Canvas page(100, 100, palette::paper);
  page.disc(50, 50, 20, {0, 0, 0});
  EXPECT_NEAR(painted(page.pixels()), pi * 400 / 1e4, 0.01);
  page.stroke({10, 5}, {90, 5}, 3, {0, 0, 0});
  EXPECT_NEAR(painted(page.pixels(), 12, 0, 76, 20), 76 * 6 / (76 * 20.0), 0.06);
}

/// All that a pattern finds in the text, its first group.
std::vector<std::string> found(const std::string& text, const std::string& pattern) {
  std::vector<std::string> all;
  const std::regex expression(pattern);
  for (std::sregex_iterator i(text.begin(), text.end(), expression), end; i != end; ++i)
    all.push_back((*i)[1]);
  return all;
}

TEST(Canvas, as_svg_holds_words_as_words_and_pictures_as_they_are) {
  Canvas page(300, 150, palette::paper);
  Image picture(20, 10, {10, 200, 30});
  page.add(picture, 5, 7);
  page.write("a < b & c\nsecond", 100, 20, {12, palette::ink, Align::center});
  page.fill(0, 100, 300, 5, ColorMap::viridis);
  const std::string svg = page.svg(150);
  EXPECT_EQ(found(svg, "<text [^>]*>([^<]*)</text>"),
            (std::vector<std::string>{"a &lt; b &amp; c", "second"}));
  EXPECT_EQ(found(svg, "viewBox=\"([^\"]*)\""), (std::vector<std::string>{"0 0 300 150"}));
  EXPECT_EQ(found(svg, " (?:width|height)=\"([0-9.]*)mm\""),
            (std::vector<std::string>{"150", "75"}));
  const std::size_t begin = svg.find("base64,") + 7;
  EXPECT_EQ(svg.substr(begin, svg.find('"', begin) - begin), base64(png_of(picture)));
  EXPECT_EQ(found(svg, "fill=\"url\\(#([^)]*)\\)\""), found(svg, "linearGradient id=\"([^\"]*)\""));
  EXPECT_EQ(found(page.svg(0), " width=\"([0-9.]*)mm\"").size(), 0U);
}

TEST(Canvas, is_written_as_png_and_for_print_as_svg_too) {
  const Folder folder;
  const auto draw = [](const Paper& paper) {
    Canvas page(64, 32, paper.background);
    page.write("words", 4, 4, {12, paper.ink});
    return page;
  };
  write_page(draw, {}, folder.file("screen.png"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("screen.svg")));
  write_page(draw, {{}, 80}, folder.file("print.png"));
  EXPECT_NE(read_file(folder.file("print.svg")).find(">words</text>"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder.file("print.png")));
}

}  // namespace sinew::canvas_test
