// SPDX-License-Identifier: GPL-3.0-or-later
// The moments that represent a motion, and what they are said to show.
#include <sinew/figures/key_moments.h>
#include <sinew/figures/snapshots.h>

#include <gtest/gtest.h>

namespace sinew::key_moments_test {

constexpr double r = 0.01;

/// A bone that turns to an angle (rad) and back, and the particles' displacements (m) in the end.
RunOverview there_and_back(double angle, double off, double end = 0) {
  RunOverview overview;
  overview.angle = {0, angle / 4, angle / 2, angle, angle, angle / 3, end};
  overview.shift = {0, angle, 2 * angle, 4 * angle, 4 * angle, angle, off};
  overview.farthest = overview.shift;
  overview.farthest.back() = 12.3 * off;
  return overview;
}

std::vector<std::string> words_of(const std::vector<KeyMoment>& moments) {
  std::vector<std::string> words;
  for (const KeyMoment& moment : moments) words.push_back(moment.what);
  return words;
}

TEST(KeyMoments, AreRestHalfTheTurnTheLastOfTheLargestAndTheEnd) {
  const auto moments = key_moments(there_and_back(1.5, 0), r);
  ASSERT_EQ(moments.size(), 4u);
  EXPECT_EQ(moments[0].frame, 0u);
  EXPECT_EQ(moments[1].frame, 2u);
  EXPECT_EQ(moments[2].frame, 4u);
  EXPECT_EQ(moments[3].frame, 6u);
}

TEST(KeyMoments, SayWhatTheyShow) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(words_of(key_moments(there_and_back(1.5, 0), r)),
            (Words{"at rest", "half way", "largest turn", "returned"}));
  EXPECT_EQ(words_of(key_moments(there_and_back(1.5, 0.41 * r), r)).back(),
            "returned, 0.41 r off in the mean, 5 r at most");
  EXPECT_EQ(words_of(key_moments(there_and_back(1.5, r, 0.7), r)).back(), "the end");
  RunOverview moved = there_and_back(1.5, 0);
  moved.shift.front() = r;
  EXPECT_EQ(words_of(key_moments(moved, r)).front(), "");
}

TEST(KeyMoments, AreThoseFarthestFromAPosedStartWhereAClipComesBackToIt) {
  RunOverview looped = there_and_back(1.5, 0);
  looped.angle = {1.4, 1.3, 1.2, 1.1, 1.2, 1.3, 1.5};
  looped.from_start = {0, r, 3 * r, 2 * r, 2 * r, r, 0};
  const auto moments = key_moments(looped, r);
  ASSERT_EQ(moments.size(), 3u);
  EXPECT_EQ(moments[1].frame, 2u);
  EXPECT_EQ(moments[1].what, "farthest from the start");
  EXPECT_EQ(moments[2].frame, 6u);
}

TEST(KeyMoments, AreSpreadEvenlyWhereNoBoneTurns) {
  RunOverview overview;
  overview.angle.assign(21, 0.0);
  overview.shift.assign(21, 0.0);
  const auto moments = key_moments(overview, r);
  ASSERT_EQ(moments.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(moments[k].frame, 5 * k);
  overview.angle.resize(1), overview.shift.resize(1);
  EXPECT_EQ(key_moments(overview, r).size(), 1u);
}

}  // namespace sinew::key_moments_test
