// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/color.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <sinew/render/snapshot.h>

namespace sinew {
namespace {

TEST(ColourMap, grows_lighter_all_the_way) {
  for (const auto& [name, map] : colour_maps())
    for (int i = 1; i <= 32; ++i)
      EXPECT_GT(oklab(mapped_colour(i / 32.0, map)).x(),
                oklab(mapped_colour((i - 1) / 32.0, map)).x())
          << name << ' ' << i;
}

TEST(ColourMap, equal_steps_look_equal) {
  const double whole = 51;  // whole steps of the table, whose colours are rounded
  for (const auto& [name, map] : colour_maps()) {
    double length = 0, longest = 0, shortest = 1;
    for (int i = 1; i <= whole; ++i) {
      const double step =
          (oklab(mapped_colour(i / whole, map)) - oklab(mapped_colour((i - 1) / whole, map)))
              .norm();
      length += step, longest = std::max(longest, step), shortest = std::min(shortest, step);
    }
    EXPECT_LT(longest, 1.35 * length / whole) << name;  // rounding is coarse near black
    EXPECT_GT(shortest, 0.75 * length / whole) << name;
  }
}

TEST(ColourMap, begin_and_end_as_they_are_known) {
  EXPECT_EQ(mapped_colour(0, ColourMap::viridis), (Colour{68, 1, 84}));
  EXPECT_EQ(mapped_colour(1, ColourMap::viridis), (Colour{253, 231, 37}));
  EXPECT_EQ(mapped_colour(1, ColourMap::cividis), (Colour{254, 232, 56}));
}

TEST(ColourMap, oklab_of_white_and_black) {
  EXPECT_NEAR((oklab({255, 255, 255}) - Vec3(1, 0, 0)).norm(), 0, 1e-3);
  EXPECT_NEAR(oklab({0, 0, 0}).norm(), 0, 1e-6);
}

TEST(ColourMap, outside_and_not_a_number_take_the_ends) {
  EXPECT_EQ(mapped_colour(-3), mapped_colour(0));
  EXPECT_EQ(mapped_colour(7), mapped_colour(1));
  EXPECT_EQ(mapped_colour(std::numeric_limits<double>::quiet_NaN()), mapped_colour(0));
}

TEST(ColourScale, places_values_between_low_and_high) {
  const ColourScale scale{"strain", "", -1, 3};
  EXPECT_DOUBLE_EQ(scale.position(-1), 0);
  EXPECT_DOUBLE_EQ(scale.position(1), 0.5);
  EXPECT_DOUBLE_EQ(scale.position(9), 1);
  EXPECT_DOUBLE_EQ((ColourScale{"flat", "", 2, 2}).position(2), 0);
}

}  // namespace
}  // namespace sinew
