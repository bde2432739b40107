// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/runs.h>

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>

namespace sinew::runs_test {

using RunList = std::vector<Run>;                 // in a test, Run is one of its own members
using Sites = std::map<std::array<int, 2>, int>;  // row and site: body

Sites sites_of(const RunList& runs) {
  Sites sites;
  for (const Run& run : runs)
    for (int site = run.first; site < run.last; ++site)
      EXPECT_TRUE(sites.try_emplace({run.row, site}, run.body).second);
  return sites;
}

/// Sorted, without empty runs and none touching with the same body.
void expect_tidy(const RunList& runs) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    ASSERT_GT(runs[i].sites(), 0);
    if (i == 0 || runs[i - 1].row < runs[i].row) continue;
    ASSERT_EQ(runs[i - 1].row, runs[i].row);
    ASSERT_LE(runs[i - 1].last, runs[i].first);
    if (runs[i - 1].last == runs[i].first) {
      ASSERT_NE(runs[i - 1].body, runs[i].body);
    }
  }
}

RunList random_runs(std::mt19937& random) {
  const auto below = [&](int n) { return static_cast<int>(random() % n); };
  RunList runs;
  for (int row = below(3); row < 6; row += 1 + below(2))
    for (int site = below(6); site < 30; site += below(3)) {
      const int last = site + 1 + below(8);
      runs.push_back({row, site, last, below(3)});
      site = last;
    }
  return runs;
}

TEST(Runs, DifferAsTheSetsOfTheirSites) {
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const auto a = random_runs(random), b = random_runs(random);
    const Sites in_b = sites_of(b);
    Sites without = sites_of(a);
    std::erase_if(without, [&](const auto& one) { return in_b.contains(one.first); });
    ASSERT_EQ(sites_of(runs_without(a, b)), without);
    expect_tidy(runs_without(a, b));
  }
}

TEST(Runs, KeepTheirBodies) {
  const RunList runs = {{0, 0, 4, 7}, {0, 4, 9, 8}};
  EXPECT_EQ(runs_without(runs, {{0, 2, 6, 1}}), (RunList{{0, 0, 2, 7}, {0, 6, 9, 8}}));
}

TEST(Runs, LoseWhatSeveralRunsThatTouchCover) {
  const RunList others = {{0, 1, 3, 0}, {0, 3, 5, 1}};
  EXPECT_EQ(runs_without({{0, 0, 6, 2}}, others), (RunList{{0, 0, 1, 2}, {0, 5, 6, 2}}));
}

TEST(Runs, OfNothing) {
  const RunList runs = {{3, 1, 2, 0}};
  EXPECT_EQ(runs_without(runs, {}), runs);
  EXPECT_TRUE(runs_without({}, runs).empty());
  EXPECT_TRUE(runs_without(runs, runs).empty());
}

}  // namespace sinew::runs_test
