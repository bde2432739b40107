// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <sinew/study/sweep/design.h>
#include <sinew/study/sweep/effects.h>

namespace sinew::study_test {
namespace {

using Function = std::function<double(const DesignPoint&)>;

std::vector<DesignPoint> random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<DesignPoint> points(count, DesignPoint(2));
  for (DesignPoint& point : points)
    for (double& value : point) value = uniform(random);
  return points;
}

/// Correlation of the ranks of a quantity and of a function.
RankCorrelation correlated(const std::vector<DesignPoint>& points, std::size_t quantity,
                           const Function& function) {
  std::vector<double> x, y;
  for (const DesignPoint& point : points)
    x.push_back(point[quantity]), y.push_back(function(point));
  return rank_correlation(x, y);
}

/// A sum of two uniform quantities, the second of this weight, 0 to 1, and what the ranks of both
/// correlate with those of the sum: 12 E[x F(y)] - 3, where F is the sum's distribution.
struct Mixture {
  double weight;
  double operator()(const DesignPoint& x) const { return x[0] + weight * x[1]; }
  double of_first() const { return 1 - weight * weight / 2 + std::pow(weight, 3) / 5; }
  double of_second() const { return weight - 0.3 * weight * weight; }
};

TEST(RankCorrelation, MonotoneDataAreCorrelatedFully) {
  const auto points = random_points(50, 1);
  const auto rising =
      correlated(points, 0, [](const DesignPoint& x) { return std::exp(9 * x[0]); });
  EXPECT_EQ(rising.value, 1);
  EXPECT_EQ(rising.error, 0);
  const auto falling =
      correlated(points, 0, [](const DesignPoint& x) { return -std::pow(x[0], 3); });
  EXPECT_EQ(falling.value, -1);
  EXPECT_EQ(falling.error, 0);
}

TEST(RankCorrelation, IndependentDataAreNotWithinThreeErrors) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto found =
        correlated(random_points(100, seed), 0, [](const DesignPoint& x) { return x[1]; });
    EXPECT_LT(std::abs(found.value), 3 * found.error) << seed;
    EXPECT_NEAR(found.error, 0.1, 0.02);  // 1 / sqrt(n - 1)
  }
}

TEST(RankCorrelation, AMixtureHasItsClosedFormWithinTheStatedError) {
  constexpr int trials = 60;
  for (const Mixture mixture : {Mixture{0.25}, Mixture{0.5}, Mixture{1}})
    for (const std::size_t quantity : {0u, 1u}) {
      const double known = quantity == 0 ? mixture.of_first() : mixture.of_second();
      int within_one = 0, within_three = 0;
      for (unsigned seed = 1; seed <= trials; ++seed) {
        const auto found = correlated(random_points(100, seed), quantity, mixture);
        within_one += std::abs(found.value - known) < found.error;
        within_three += std::abs(found.value - known) < 3 * found.error;
      }
      EXPECT_NEAR(within_one, 0.68 * trials, 3 * std::sqrt(trials * 0.68 * 0.32));
      EXPECT_GE(within_three, trials - 2) << mixture.weight << ", quantity " << quantity;
    }
}

TEST(RankCorrelation, DesignsOfStudiesGiveTheClosedForm) {
  constexpr Mixture mixture{0.5};
  for (const auto& points : {latin_hypercube(200, 2, 1), sobol(200, 2, 1)})
    for (const std::size_t quantity : {0u, 1u}) {
      const auto found = correlated(points, quantity, mixture);
      EXPECT_NEAR(found.value, quantity == 0 ? 0.9 : 0.425, 2 * found.error);
    }
}

TEST(RankCorrelation, EqualValuesShareTheirMeanRank) {
  // Ranks 0.5 0.5 2.5 2.5 4.5 4.5 6.5 6.5 8.5 8.5 of 0 to 9: 80 / sqrt(80 * 82.5).
  const std::vector<double> x = {0, 0, 1, 1, 2, 2, 3, 3, 4, 4}, y = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  EXPECT_NEAR(rank_correlation(x, y).value, std::sqrt(80 / 82.5), 1e-12);
}

TEST(RankCorrelation, IsNotToldOfTooFewOrConstantData) {
  std::vector<double> x = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, y = x;
  EXPECT_EQ(rank_correlation(x, y).value, 1);
  EXPECT_TRUE(std::isnan(rank_correlation(x, std::vector<double>(10, 2)).value));
  y[3] = not_measured;
  EXPECT_TRUE(std::isnan(rank_correlation(x, y).value));
  x.push_back(10), y.push_back(11);  // ten pairs without the one
  EXPECT_EQ(rank_correlation(x, y).value, 1);
}

TEST(MainEffect, IsTheRangeOfTheMeansOfLevels) {
  const std::vector<std::size_t> level = {0, 1, 2, 0, 1, 2, 2};
  const auto means = level_means(level, std::vector<double>{1, 5, 2, 3, 7, not_measured, 4}, 4);
  ASSERT_EQ(means.size(), 4u);
  EXPECT_EQ(means[0].mean, 2);
  EXPECT_EQ(means[1].mean, 6);
  EXPECT_EQ(means[2].mean, 3);
  EXPECT_EQ(means[2].runs, 2u);
  EXPECT_TRUE(std::isnan(means[3].mean));
  EXPECT_EQ(main_effect(means), 4);
  EXPECT_TRUE(std::isnan(main_effect(std::vector<LevelMean>{means[0], means[3]})));
}

}  // namespace
}  // namespace sinew::study_test
