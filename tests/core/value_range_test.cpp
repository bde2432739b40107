// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/value_range.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "support/expect_error.h"

namespace sinew::value_range_test {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Found by sorting all of them.
ValueRange sorted_range(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto outside = static_cast<std::size_t>(0.005 * static_cast<double>(values.size()));
  return {values[outside], values[values.size() - 1 - outside]};
}

TEST(RangeFinder, FindsThePercentilesOfAllFramesTogether) {
  std::mt19937 random(7);
  std::normal_distribution<double> bell(3, 2);
  std::vector<double> all;
  RangeFinder finder;
  for (int frame = 0; frame < 20; ++frame) {
    std::vector<double> values(997);
    for (double& value : values) value = bell(random) * (frame + 1);
    finder.add(values);
    all.insert(all.end(), values.begin(), values.end());
  }
  const ValueRange found = finder.range(), wanted = sorted_range(all);
  EXPECT_NEAR(found.low / wanted.low, 1, 1.0 / 4000);
  EXPECT_NEAR(found.high / wanted.high, 1, 1.0 / 4000);
}

TEST(RangeFinder, IsRightForAnySize) {
  for (const double size : {1e-30, 1e-9, 1.0, 1e12, 1e30})
    for (const double sign : {1.0, -1.0}) {
      RangeFinder finder;
      std::vector<double> values;
      for (int k = 0; k < 1000; ++k) values.push_back(sign * size * (9 + 0.001 * k));
      finder.add(values);
      const ValueRange found = finder.range(), wanted = sorted_range(values);
      EXPECT_NEAR(found.low / wanted.low, 1, 1.0 / 4000) << size;
      EXPECT_NEAR(found.high / wanted.high, 1, 1.0 / 4000) << size;
    }
}

TEST(RangeFinder, BeginsAtZeroWhereThatIsNearAndNothingIsNegative) {
  std::vector<double> values;
  for (int k = 0; k <= 1000; ++k) values.push_back(0.2 + 0.001 * k);
  RangeFinder near, far, negative;
  near.add(values);
  EXPECT_EQ(near.range().low, 0);
  for (double& value : values) value += 2;
  far.add(values);
  EXPECT_GT(far.range().low, 2.1);
  for (double& value : values) value -= 3;
  negative.add(values);
  EXPECT_LT(negative.range().low, -0.7);
}

TEST(RangeFinder, LeavesOutWhatIsNotFiniteAndAFewThatEscaped) {
  std::vector<double> values(1000, 1.0);
  values[1] = values[2] = 1e9;
  values[3] = not_a_number, values[4] = std::numeric_limits<double>::infinity();
  RangeFinder finder;
  finder.add(values);
  EXPECT_NEAR(finder.range().high, 1, 1.0 / 4000);
  RangeFinder none;
  none.add(std::vector<double>{not_a_number});
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.range().high, 0);
}

TEST(RangeFinder, IsOfZerosAlone) {
  RangeFinder finder;
  finder.add(std::vector<double>(10, 0.0));
  EXPECT_EQ(finder.range().low, 0);
  EXPECT_EQ(finder.range().high, 0);
}

TEST(ColorRange, IsTwoNumbersTheLowerOneFirst) {
  EXPECT_EQ(color_range(std::vector<double>{-1, 2}).high, 2);
  for (const std::vector<double>& wrong :
       {std::vector<double>{1}, {1, 1}, {2, 1}, {0, 1, 2}, {0, not_a_number}})
    test::expect_bad_input([&] { color_range(wrong); }, {"--range 0,0.5"});
}

}  // namespace sinew::value_range_test
