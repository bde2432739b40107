// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/elevations.h>

#include <cmath>

#include "helpers.h"
#include "synthetic_run.h"

namespace sinew::elevations_test {

TEST(Ticks, cover_their_range_in_round_steps) {
  for (const double step : {0.0007, 0.013, 0.2, 0.21, 1.0, 9.0, 330.0})
    for (const double low : {-3.7, 0.0, 0.5}) {
      const double high = low + 4.3 * step;
      const Ticks ticks = ticks_over(low, high, step);
      const double apart = ticks.at(1) - ticks.at(0);
      EXPECT_LE(ticks.low(), low + 1e-6 * apart);
      EXPECT_GT(ticks.low(), low - apart);
      EXPECT_GE(ticks.high(), high - 1e-6 * apart);
      EXPECT_LT(ticks.high(), high + apart * (1 + 1e-6));
      EXPECT_GE(apart, step * (1 - 1e-6));
      EXPECT_LE(apart, 2.5 * step);
      const int m = ticks.mantissa;
      EXPECT_TRUE(m == 1 || m == 2 || m == 5 || m == 10) << m;
    }
}

TEST(Ticks, far_from_0_are_counted_from_one_of_them) {
  EXPECT_EQ(ticks_over(10, 10.6, 0.1).base(), 0);
  for (const double far : {403000.123, -3604900.456, 1e12}) {
    const Ticks ticks = ticks_over(far, far + 0.6, 0.1);
    EXPECT_LE(std::abs(ticks.at(ticks.base()) - ticks.low()), 1) << far;
    EXPECT_LT(std::abs(ticks.at(ticks.last - ticks.base())), 2) << far;
  }
}

TEST(Ticks, are_the_numbers_they_show) {
  EXPECT_EQ(ticks_over(0, 0.6, 0.15).at(3), 0.6);
  EXPECT_EQ(ticks_over(0, 600, 150).at(3), 600);
}

/// Pixels nearer to `color` than to most others.
int pixels_like(const Image& image, const Color& color, int x, int width) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int column = x; column < x + width; ++column) {
      int apart = 0;
      for (int c = 0; c < 3; ++c) apart += std::abs(image.at(column, y)[c] - color[c]);
      count += apart < 60;
    }
  return count;
}

Snapshot plan() {
  Snapshot snapshot = synthetic_snapshot(0, 0);
  snapshot.values.clear();
  snapshot.particles.resize(1);
  snapshot.marks = {Mark::sample};
  return snapshot;
}

Image drawn(const Snapshot& snapshot) {
  Painter painter(snapshot.surface, {});
  return elevations(painter, snapshot, {.width = 640, .height = 360}).pixels();
}

TEST(Elevations, show_skin_bones_and_the_sample_from_two_sides) {
  const Image image = drawn(plan());
  EXPECT_EQ(image.width, 640);
  EXPECT_EQ(image.height, 360);
  for (const int x : {0, 320}) {
    EXPECT_GT(painted(image, x, 0, 320, 300), 0.05);
    EXPECT_GT(pixels_like(image, palette::bone, x, 320), 100);
    EXPECT_GT(pixels_like(image, palette::sample, x, 320), 10);
  }
}

TEST(Elevations, of_flat_bodies_have_a_third_side) {
  Snapshot flat;
  flat.surface.points = {{0, 0, 0},    {1, 0, 0},    {1, 1, 0},    {0, 1, 0},
                         {0, 0, 0.25}, {1, 0, 0.25}, {1, 1, 0.25}, {0, 1, 0.25}};
  flat.surface.faces = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                        {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  const auto left_over_right = [&] {
    const Image image = drawn(flat);
    return painted(image, 0, 20, 320, 270) / painted(image, 320, 20, 320, 270);
  };
  EXPECT_NEAR(left_over_right(), 2, 0.4);  // the top beside the front and the side
  for (std::size_t k = 4; k < 8; ++k) flat.surface.points[k].z() = 1;
  EXPECT_NEAR(left_over_right(), 1, 0.1);
}

TEST(Elevations, mark_what_is_held_and_muscles) {
  Snapshot snapshot = plan();
  snapshot.bones.clear();
  const Image without = drawn(snapshot);
  snapshot.particles = synthetic_snapshot(0, 0).particles;
  snapshot.marks.assign(snapshot.particles.size(), Mark::none);
  EXPECT_LT(pixels_like(drawn(snapshot), palette::held, 0, 640),
            1.1 * pixels_like(without, palette::held, 0, 640) + 200);
  snapshot.marks.assign(snapshot.particles.size(), Mark::held);
  EXPECT_GT(pixels_like(drawn(snapshot), palette::held, 0, 640), 5000);
  snapshot.marks.assign(snapshot.particles.size(), Mark::muscle);
  const Image red = drawn(snapshot);
  EXPECT_LT(pixels_like(red, palette::muscle, 0, 640), 200);  // a tint alone
  EXPECT_GT(pixels_like(red, {236, 160, 156}, 0, 640), 5000);
}

}  // namespace sinew::elevations_test
