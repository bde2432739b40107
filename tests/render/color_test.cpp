// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/color.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <sinew/render/snapshot.h>

namespace sinew::color_test {

TEST(ColorMap, grows_lighter_all_the_way) {
  for (const auto& [name, map] : color_maps())
    for (int i = 1; i <= 32; ++i)
      EXPECT_GT(oklab(mapped_color(i / 32.0, map)).x(),
                oklab(mapped_color((i - 1) / 32.0, map)).x())
          << name << ' ' << i;
}

TEST(ColorMap, equal_steps_look_equal) {
  const double whole = 51;  // whole steps of the table, whose colors are rounded
  for (const auto& [name, map] : color_maps()) {
    double length = 0, longest = 0, shortest = 1;
    for (int i = 1; i <= whole; ++i) {
      const double step =
          (oklab(mapped_color(i / whole, map)) - oklab(mapped_color((i - 1) / whole, map))).norm();
      length += step, longest = std::max(longest, step), shortest = std::min(shortest, step);
    }
    EXPECT_LT(longest, 1.35 * length / whole) << name;  // rounding is coarse near black
    EXPECT_GT(shortest, 0.75 * length / whole) << name;
  }
}

TEST(ColorMap, begin_and_end_as_they_are_known) {
  EXPECT_EQ(mapped_color(0, ColorMap::viridis), (Color{68, 1, 84}));
  EXPECT_EQ(mapped_color(1, ColorMap::viridis), (Color{253, 231, 37}));
  EXPECT_EQ(mapped_color(1, ColorMap::cividis), (Color{254, 232, 56}));
}

TEST(ColorMap, oklab_of_white_and_black) {
  EXPECT_NEAR((oklab({255, 255, 255}) - Vec3(1, 0, 0)).norm(), 0, 1e-3);
  EXPECT_NEAR(oklab({0, 0, 0}).norm(), 0, 1e-6);
}

TEST(ColorMap, outside_takes_the_ends_and_not_a_number_is_gray) {
  EXPECT_EQ(mapped_color(-3), mapped_color(0));
  EXPECT_EQ(mapped_color(7), mapped_color(1));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(mapped_color(nan), palette::no_value);
  EXPECT_EQ(mapped_color(ColorScale{"J", "", 0, 1}.position(nan)), palette::no_value);
}

TEST(ColorScale, places_values_between_low_and_high) {
  const ColorScale scale{"strain", "", -1, 3};
  EXPECT_DOUBLE_EQ(scale.position(-1), 0);
  EXPECT_DOUBLE_EQ(scale.position(1), 0.5);
  EXPECT_DOUBLE_EQ(scale.position(9), 1);
  EXPECT_DOUBLE_EQ((ColorScale{"flat", "", 2, 2}).position(2), 0);
}

TEST(Color, is_read_from_six_hexadecimal_digits) {
  EXPECT_EQ(hex_color("#f5A00c"), (Color{245, 160, 12}));
  for (const char* text :
       {"", "#", "f5a00c", "#f5a00", "#f5a00cc", "#f5a00g", "#+5a00c", "#-5a00c"})
    EXPECT_FALSE(hex_color(text)) << text;
}

TEST(Color, ink_is_read_on_its_background) {
  for (const NamedColor& named : named_colors()) {
    const Paper paper = paper_of(named.color);
    EXPECT_GT(std::abs(oklab(paper.ink)[0] - oklab(paper.background)[0]), 0.28) << named.name;
  }
}

TEST(ReadableOn, StandsOutFromAnyPaper) {
  for (const Color& paper :
       {Color{255, 255, 255}, Color{21, 24, 29}, Color{0, 0, 0}, Color{128, 128, 128}})
    for (const Color& ink : {palette::bone, palette::held, palette::faint_ink, palette::loaded})
      EXPECT_GE(std::abs(oklab(readable_on(paper, ink))[0] - oklab(paper)[0]), 0.27);
  EXPECT_EQ(readable_on({255, 255, 255}, palette::bone), palette::bone);
}

}  // namespace sinew::color_test
