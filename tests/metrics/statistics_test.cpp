// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/statistics.h>

#include <gtest/gtest.h>

namespace sinew::test::statistics_test {

TEST(Statistics, OfManyNumbersAreTheirClosedForms) {
  constexpr std::size_t n = 100000;
  for (const int threads : {1, 2, 8})
    with_threads(threads, [&] {
      const Statistics all =
          statistics(n, [](std::size_t i) { return static_cast<double>(i) + 1; });
      EXPECT_EQ(all.count, n);
      EXPECT_EQ(all.mean(), (n + 1) / 2.0);
      EXPECT_DOUBLE_EQ(all.rms(), std::sqrt((n + 1) * (2.0 * n + 1) / 6));
      EXPECT_EQ(all.min(), 1);
      EXPECT_EQ(all.max(), static_cast<double>(n));
    });
}

TEST(Statistics, OfNothingAreNotANumber) {
  for (const double value : {Statistics{}.mean(), Statistics{}.rms(), Statistics{}.min(),
                             statistics(0, [](std::size_t) { return 1.0; }).max()})
    EXPECT_TRUE(std::isnan(value));
}

TEST(Statistics, OfOneNumberAreThatNumber) {
  const Statistics one = statistics(1, [](std::size_t) { return 3.0; });
  for (const double value : {one.mean(), one.rms(), one.min(), one.max()}) EXPECT_EQ(value, 3);
}

TEST(Statistics, PercentilesAreNearestRanksOfWhatWasMeasured) {
  std::vector<double> values;
  for (int i = 100; i > 0; --i) values.push_back(i);
  values.push_back(not_measured);
  for (const double percent : {1.0, 50.0, 95.0, 100.0})
    EXPECT_EQ(percentile(values, percent), percent);
  std::vector<double> none{not_measured};
  EXPECT_TRUE(std::isnan(percentile(none, 50)));
}

}  // namespace sinew::test::statistics_test
