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
  EXPECT_EQ(one.order, other.order);
}

TEST(ContinuumLimit, ValuesThatScatterHaveNoOrderAndALargeError) {
  const ContinuumLimit limit =
      continuum_limit(std::vector<double>{0.01, 0.014, 0.02}, std::vector<double>{1, 2, 1});
  EXPECT_TRUE(std::isnan(limit.order));
  EXPECT_GT(limit.error, 1);
}

TEST(ContinuumLimit, OfMoreSizesAParabolaIsExactToo) {
  const std::vector<double> sizes = {0.01, 0.014, 0.02, 0.03};
  const ContinuumLimit limit = limit_by(sizes, [](double h) { return 5 + h - 8 * h * h; });
  EXPECT_NEAR(limit.value, 5, 1e-12);
}

TEST(ContinuumLimit, ValuesThatScatterAreWithinTheErrorNineteenTimesOfTwenty) {
  const std::vector<double> sizes = {0.006, 0.008, 0.01, 0.012, 0.014, 0.016, 0.018, 0.02};
  std::mt19937 random(1);
  std::normal_distribution<double> scatter(0, 0.03);
  int held = 0;
  const int trials = 1000;
  for (int trial = 0; trial < trials; ++trial) {
    const auto limit = limit_by(sizes, [&](double h) { return 2 - 10 * h + scatter(random); });
    held += std::abs(limit.value - 2) <= limit.error;
    EXPECT_TRUE(std::isnan(limit.order));
  }
  EXPECT_GT(held, 0.88 * trials);  // two standard errors with 6 degrees of freedom: 0.91
  EXPECT_LT(held, 0.97 * trials);
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

}  // namespace
}  // namespace sinew::study_test
