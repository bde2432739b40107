// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/shading.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sinew::occlusion_test {

constexpr int side = 40;

template <typename Depth>
std::vector<float> hidden(Depth depth) {
  DepthImage image{side, side, 1, {}};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) image.depth.push_back(static_cast<float>(depth(x, y)));
  return occlusion(image, 8);
}

TEST(Occlusion, a_tilted_plane_hides_nothing_of_its_sky) {
  const std::vector<float> result = hidden([](int x, int y) { return 100 + 0.5 * x - 0.25 * y; });
  for (int y = 10; y < 30; ++y)
    for (int x = 10; x < 30; ++x) EXPECT_NEAR(result[y * side + x], 0, 1e-6);
}

TEST(Occlusion, a_valley_is_darkest_at_its_bottom) {
  const std::vector<float> result = hidden([](int x, int) { return 100 - std::abs(x - 20); });
  EXPECT_GT(result[20 * side + 20], 0.1);
  EXPECT_GT(result[20 * side + 20], result[20 * side + 25]);
  EXPECT_NEAR(result[20 * side + 32], 0, 1e-6);
}

TEST(Occlusion, a_ridge_and_an_empty_sky_are_open) {
  constexpr double nothing = std::numeric_limits<double>::infinity();
  for (const float value : hidden([](int x, int) { return 100 + std::abs(x - 20); }))
    EXPECT_LT(value, 0.02);
  for (const float value : hidden([](int, int) { return nothing; })) EXPECT_EQ(value, 0);
  for (const float value : hidden([](int x, int) { return x < 20 ? 100 : nothing; }))
    EXPECT_NEAR(value, 0, 1e-6);
}

}  // namespace sinew::occlusion_test
