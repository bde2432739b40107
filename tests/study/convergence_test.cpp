// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include <sinew/study/convergence.h>

namespace sinew::study_test {
namespace {

template <class Law>
ContinuumLimit limit_by(const std::vector<double>& sizes, const Law& law) {
  std::vector<double> values;
  for (const double size : sizes) values.push_back(law(size));
  return continuum_limit(sizes, values);
}

const std::vector<double> three = {0.02, 0.01, 0.014};

TEST(ContinuumLimit, FirstOrderIsExact) {
  const ContinuumLimit limit = limit_by(three, [](double h) { return 2 - 30 * h; });
  EXPECT_NEAR(limit.value, 2, 1e-12);
  EXPECT_NEAR(limit.error, 0, 1e-12);
  EXPECT_NEAR(limit.order, 1, 1e-9);
}

TEST(ContinuumLimit, SecondOrderIsExactAndTheErrorSaysThatALineWouldMiss) {
  const ContinuumLimit limit = limit_by(three, [](double h) { return 2 + 100 * h * h; });
  EXPECT_NEAR(limit.value, 2, 1e-12);
  EXPECT_NEAR(limit.order, 2, 1e-9);
  // A line through 0.01 and 0.014 meets 0 at 2 - 100 * 0.01 * 0.014.
  EXPECT_GE(limit.error, 0.014);
  EXPECT_LT(limit.error, 0.03);
}

TEST(ContinuumLimit, BothOrdersTogetherAreExactToo) {
  const ContinuumLimit limit = limit_by(three, [](double h) { return 2 - 30 * h + 100 * h * h; });
  EXPECT_NEAR(limit.value, 2, 1e-12);
}

TEST(ContinuumLimit, TheErrorHoldsTheLimitOfAnotherOrder) {
  for (const double order : {0.7, 1.5, 3.0}) {
    const ContinuumLimit limit =
        limit_by(three, [&](double h) { return 2 + std::pow(10 * h, order); });
    EXPECT_NEAR(limit.order, order, 1e-6);
    EXPECT_LE(std::abs(limit.value - 2), 1.0001 * limit.error) << order;
  }
}

TEST(ContinuumLimit, DoesNotDependOnTheOrderOfTheRuns) {
  const std::vector<double> sizes = {0.01, 0.02, 0.014, 0.03};
  const ContinuumLimit one = continuum_limit(sizes, std::vector<double>{1, 1.3, 1.1, 1.7});
  const ContinuumLimit other = continuum_limit(std::vector<double>{0.03, 0.014, 0.01, 0.02},
                                               std::vector<double>{1.7, 1.1, 1, 1.3});
  EXPECT_EQ(one.value, other.value);
  EXPECT_EQ(one.error, other.error);
  EXPECT_EQ(std::isnan(one.order), std::isnan(other.order));
}

TEST(ContinuumLimit, ValuesThatApproachNoneHaveNoLimit) {
  const std::vector<double> radii = {0.016, 0.02, 0.025};
  for (const std::vector<double>& values : std::vector<std::vector<double>>{
           {1, 2, 1}, {-0.862, 0.261, 0.263}, {91.1, 90.6, 92}, {3, 2, 1.5}, {1.04, 1.06, 0.978}}) {
    const ContinuumLimit limit = continuum_limit(radii, values);
    EXPECT_TRUE(std::isnan(limit.value)) << values[0] << ": " << limit.value;
    EXPECT_TRUE(std::isnan(limit.error) && std::isnan(limit.order));
  }
  EXPECT_TRUE(std::isnan(limit_by({1, 2, 4}, [](double h) { return std::pow(h, -0.5); }).value));
  EXPECT_NEAR(limit_by(three, [](double h) { return h * h; }).value, 0, 1e-12);
}

TEST(ContinuumLimit, IsNeverOutsideOfItsRange) {
  const ContinuumLimit limit = {-0.1, 0.2, 1};
  EXPECT_EQ(within(limit, {0, 1}).value, 0);
  EXPECT_EQ(within(limit, {0, 1}).error, 0.2);
  EXPECT_TRUE(std::isnan(within(limit, {0.2, 1}).value));
  EXPECT_TRUE(std::isnan(within(limit, {-1, -0.4}).error));
  EXPECT_EQ(within(limit, {-1, 1}).value, -0.1);
}

TEST(ContinuumLimit, OfMoreSizesAParabolaIsExactToo) {
  const std::vector<double> sizes = {0.01, 0.014, 0.02, 0.03};
  const ContinuumLimit limit = limit_by(sizes, [](double h) { return 5 + h - 8 * h * h; });
  EXPECT_NEAR(limit.value, 5, 1e-12);
}

/// How many of 1,000 limits of values that scatter by .03 about a law that tends to 2 are within
/// their error; and the error on average.
struct Coverage {
  int limits = 0;
  double error = 0;
};

template <class Law>
Coverage covered_by_error(const std::vector<double>& sizes, double deviation, const Law& law) {
  std::mt19937 random(1);
  std::normal_distribution<double> scatter(0, deviation);
  Coverage coverage;
  for (int trial = 0; trial < 1000; ++trial) {
    const auto limit = limit_by(sizes, [&](double h) { return law(h) + scatter(random); });
    if (std::isnan(limit.value)) continue;
    coverage.limits += std::abs(limit.value - 2) <= limit.error;
    coverage.error += limit.error / 1000;
  }
  return coverage;
}

TEST(ContinuumLimit, ValuesThatScatterAreWithinTheErrorNineTimesOfTen) {
  const std::vector<double> eight = {0.006, 0.008, 0.01, 0.012, 0.014, 0.016, 0.018, 0.02};
  const std::vector<double> four = {0.006, 0.01, 0.014, 0.02};
  for (const auto& sizes : {four, eight})
    for (const double deviation : {0.03, 0.003}) {
      const Coverage first =
          covered_by_error(sizes, deviation, [](double h) { return 2 - 10 * h; });
      const Coverage second =
          covered_by_error(sizes, deviation, [](double h) { return 2 + 500 * h * h; });
      const Coverage none = covered_by_error(sizes, deviation, [](double) { return 2.0; });
      for (const Coverage& coverage : {first, second, none}) {
        EXPECT_GT(coverage.limits, 870) << sizes.size() << " values, " << deviation;
        EXPECT_LT(coverage.error, 10 * deviation);  // an error that is never exceeded tells nothing
      }
    }
}

TEST(ContinuumLimit, ValuesThatConvergeByOneOrderTellIt) {
  const std::vector<double> sizes = {0.01, 0.014, 0.02, 0.03};
  std::mt19937 random(2);
  std::normal_distribution<double> scatter(0, 1e-5);
  for (const int order : {1, 2}) {
    const auto limit =
        limit_by(sizes, [&](double h) { return 3 + std::pow(10 * h, order) + scatter(random); });
    EXPECT_NEAR(limit.value, 3, 1e-4);
    EXPECT_LT(limit.error, 3e-3);
    EXPECT_EQ(limit.order, order);
  }
}

TEST(ContinuumLimit, ACantileverConvergesByTheSecondOrder) {
  // Deflections of a cantilever of 5 to 11 layers over the elastica's.
  const ContinuumLimit limit = continuum_limit(std::vector<double>{1. / 5, 1. / 7, 1. / 9, 1. / 11},
                                               std::vector<double>{1.1698, 1.0893, 1.0514, 1.0355});
  EXPECT_NEAR(limit.value, 1, 0.005);
  EXPECT_LT(limit.error, 0.04);
  EXPECT_EQ(limit.order, 2);
}

TEST(ContinuumLimit, AConstantIsItsOwnLimit) {
  const ContinuumLimit limit = limit_by(three, [](double) { return 7.0; });
  EXPECT_NEAR(limit.value, 7, 1e-12);
  EXPECT_NEAR(limit.error, 0, 1e-12);
  EXPECT_TRUE(std::isnan(limit.order));
}

TEST(ContinuumLimit, TwoSizesGiveALineAndDoubtIt) {
  const ContinuumLimit limit =
      continuum_limit(std::vector<double>{0.02, 0.01}, std::vector<double>{1.2, 1.1});
  EXPECT_NEAR(limit.value, 1, 1e-12);
  EXPECT_NEAR(limit.error, 0.1, 1e-12);
}

TEST(ContinuumLimit, WhatWasNotMeasuredHasNoLimit) {
  EXPECT_TRUE(std::isnan(continuum_limit(three, std::vector<double>{1, not_measured, 1}).value));
  EXPECT_TRUE(std::isnan(continuum_limit(std::vector<double>{0.1}, std::vector<double>{1}).value));
}

TEST(LargestOfOneSign, KeepsItsSideThroughAllSizes) {
  const std::vector<std::vector<double>> runs = {
      {0.9, -1.0}, {1.02, -1.01}, {not_measured, -1.02}, {}};
  const std::vector<double> low = largest_of_one_sign(runs);
  EXPECT_EQ(std::vector<double>(low.begin(), low.begin() + 3), (std::vector{-1.0, -1.01, -1.02}));
  EXPECT_TRUE(std::isnan(low[3]));
  std::vector<std::vector<double>> other = runs;
  for (auto& run : other)
    for (double& value : run) value = -value;
  EXPECT_EQ(largest_of_one_sign(other)[1], 1.01);
  const std::vector<std::vector<double>> one = {{0.5, 2, -1}};
  EXPECT_EQ(largest_of_one_sign(one)[0], 2);
}

}  // namespace
}  // namespace sinew::study_test
