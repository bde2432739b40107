// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <sinew/study/sweep/design.h>
#include <sinew/study/sweep/sweep_file.h>
#include "support/temp_folder.h"

namespace sinew::study_test {
namespace {

std::vector<double> column(const std::vector<DesignPoint>& points, std::size_t quantity) {
  std::vector<double> values;
  for (const DesignPoint& point : points) values.push_back(point[quantity]);
  return values;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const double a = mean_of(x), b = mean_of(y);
  double xy = 0, xx = 0, yy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xy += (x[k] - a) * (y[k] - b);
    xx += (x[k] - a) * (x[k] - a);
    yy += (y[k] - b) * (y[k] - b);
  }
  return xy / std::sqrt(xx * yy);
}

/// The square of the L2 star discrepancy, by Warnock's formula.
double squared_discrepancy(const std::vector<DesignPoint>& points) {
  const auto count = static_cast<double>(points.size());
  const auto quantities = static_cast<double>(points[0].size());
  double singles = 0, pairs = 0;
  for (const DesignPoint& x : points) {
    double product = 1;
    for (const double value : x) product *= (1 - value * value) / 2;
    singles += product;
    for (const DesignPoint& y : points) {
      double shared = 1;
      for (std::size_t q = 0; q < x.size(); ++q) shared *= 1 - std::max(x[q], y[q]);
      pairs += shared;
    }
  }
  return std::pow(3, -quantities) - 2 * singles / count + pairs / (count * count);
}

/// Its mean over independent points.
double squared_discrepancy_of_random_points(double count, double quantities) {
  return (std::pow(2, -quantities) - std::pow(3, -quantities)) / count;
}

TEST(LatinHypercube, EachPartHoldsOneNumberOfEachQuantity) {
  for (const std::size_t samples : {1u, 2u, 7u, 200u})
    for (const std::int64_t seed : {0, 1, 2}) {
      const auto points = latin_hypercube(samples, 5, seed);
      ASSERT_EQ(points.size(), samples);
      for (std::size_t q = 0; q < 5; ++q) {
        std::set<double> parts;
        for (const double value : column(points, q)) {
          EXPECT_GE(value, 0);
          EXPECT_LT(value, 1);
          parts.insert(std::floor(value * static_cast<double>(samples)));
        }
        EXPECT_EQ(parts.size(), samples);
      }
    }
}

TEST(LatinHypercube, SeedsDecideAndQuantitiesAreIndependent) {
  const auto points = latin_hypercube(200, 5, 1);
  EXPECT_EQ(points, latin_hypercube(200, 5, 1));
  EXPECT_NE(points, latin_hypercube(200, 5, 2));
  for (std::size_t q = 0; q < 5; ++q)
    for (std::size_t p = 0; p < q; ++p)
      EXPECT_LT(std::abs(correlation(column(points, p), column(points, q))), 3 / std::sqrt(200));
}

TEST(Sobol, BeginsAsPublishedWithoutASeed) {
  // The points behind the origin in three dimensions, by the numbers of Joe and Kuo (2008).
  const std::vector<DesignPoint> published = {
      {0.5, 0.5, 0.5},       {0.75, 0.25, 0.25},       {0.25, 0.75, 0.75},
      {0.375, 0.375, 0.625}, {0.875, 0.875, 0.125},    {0.625, 0.125, 0.875},
      {0.125, 0.625, 0.375}, {0.1875, 0.3125, 0.9375}, {0.6875, 0.8125, 0.4375}};
  EXPECT_EQ(sobol(published.size(), 3, 0), published);
}

TEST(Sobol, MeansAreThoseOfTheCube) {
  for (std::size_t q = 0; q < 5; ++q) {
    // Without a shift, 255 points behind the origin are all multiples of 1/256.
    EXPECT_EQ(mean_of(column(sobol(255, 5, 0), q)), 0.5);
    EXPECT_NEAR(mean_of(column(sobol(256, 5, 7), q)), 0.5, 1. / 256);
  }
}

TEST(Sobol, FillsTheCubeMoreEvenlyThanRandomPoints) {
  for (const std::size_t quantities : {2u, 5u})
    for (const std::int64_t seed : {0, 1, 2, 3}) {
      const auto points = sobol(256, quantities, seed);
      for (const DesignPoint& point : points)
        for (const double value : point) EXPECT_TRUE(value >= 0 && value < 1);
      EXPECT_LT(squared_discrepancy(points),
                squared_discrepancy_of_random_points(256, static_cast<double>(quantities)) / 4)
          << quantities << " quantities, seed " << seed;
    }
  EXPECT_EQ(sobol(64, 5, 1), sobol(64, 5, 1));
  EXPECT_NE(sobol(64, 5, 1), sobol(64, 5, 2));
}

TEST(Grid, HasEveryCombinationTheLastFastest) {
  using Places = std::vector<std::vector<std::size_t>>;
  EXPECT_EQ(grid({2, 3}), (Places{{0, 0}, {0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}}));
  EXPECT_EQ(grid({1, 1, 1}), (Places{{0, 0, 0}}));
  EXPECT_EQ(grid({3, 0}), Places{});
}

TEST(StudyFile, WithoutASettingIsRefusedWhateverTheDesign) {
  TempFolder folder;
  for (const char* design : {"grid", "list", "{kind: sobol, samples: 3}"}) {
    const auto path = folder.write(
        "study.yaml", "scene: a.yaml\nvary: {}\ndesign: " + std::string(design) + '\n');
    try {
      values_of(read_sweep(path));
      FAIL() << design;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("study.yaml:2:7: vary names no setting; write"),
                std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace sinew::study_test
