// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/summary.h>

#include <gtest/gtest.h>

#include <sinew/core/error.h>
#include <sinew/metrics/table.h>
#include "metrics/world.h"

namespace sinew::test::summary_test {

FrameMetrics frame(double bone_angle, double displacement, double J = 1) {
  FrameMetrics out;
  out.bone_angle = bone_angle;
  out.bone_shift = 0;
  out.displacement_rms = displacement;
  out.J_min = J;
  return out;
}

TEST(Summary, HoldsExtremesMeanAndTheLastFrame) {
  const std::vector<FrameMetrics> frames{frame(0, 0.5), frame(10, 2), frame(20, 1)};
  const MetricSummary s = summarize(frames, r).metrics[metric_index("displacement_rms")];
  EXPECT_EQ(s.min, 0.5);
  EXPECT_EQ(s.max, 2);
  EXPECT_EQ(s.mean, 3.5 / 3);
  EXPECT_EQ(s.final, 1);
  EXPECT_EQ(s.worst_frame, 1u);
}

TEST(Summary, TheWorstFrameIsTheOneWithTheSmallestWhereSmallIsBad) {
  const std::vector<FrameMetrics> frames{frame(0, 0, 1.2), frame(0, 0, -3), frame(0, 0, 0.5)};
  EXPECT_EQ(summarize(frames, r).metrics[metric_index("J_min")].worst_frame, 1u);
}

TEST(Summary, TheWorstResidualOfEnergyIsTheOneFarthestFromZero) {
  std::vector<FrameMetrics> frames(3);
  frames[0].energy_residual = 1;
  frames[1].energy_residual = -2;
  frames[2].energy_residual = 0.5;
  EXPECT_EQ(summarize(frames, r).metrics[metric_index("energy_residual")].worst_frame, 1u);
}

TEST(Summary, SkipsFramesInWhichAMetricWasNotMeasured) {
  std::vector<FrameMetrics> frames(3);
  frames[1].J_min = 0.25;
  const MetricSummary s = summarize(frames, r).metrics[metric_index("J_min")];
  EXPECT_EQ(s.mean, 0.25);
  EXPECT_EQ(s.worst_frame, 1u);
  EXPECT_TRUE(std::isnan(s.final));
  EXPECT_FALSE(summarize(frames, r).metrics[metric_index("J_mean")].worst_frame);
}

TEST(Summary, TheResidualIsWhatStaysWhenTheBonesAreBack) {
  const std::vector<FrameMetrics> back{frame(0, 0), frame(90, 0.3), frame(0.05, 0.004)};
  EXPECT_EQ(summarize(back, r).residual_rms, 0.004);
}

TEST(Summary, ThereIsNoResidualWithoutMotionOrReturn) {
  const std::vector<FrameMetrics> still{frame(0, 0), frame(0.01, 0.004)};
  const std::vector<FrameMetrics> away{frame(0, 0), frame(90, 0.3), frame(0.2, 0.1)};
  EXPECT_TRUE(std::isnan(summarize(still, r).residual_rms));
  EXPECT_TRUE(std::isnan(summarize(away, r).residual_rms));
  std::vector<FrameMetrics> shifted{frame(0, 0), frame(90, 0.3), frame(0, 0.1)};
  shifted.back().bone_shift = 0.01 * r;
  EXPECT_TRUE(std::isnan(summarize(shifted, r).residual_rms));
}

TEST(Summary, OvershootIsWhatTheTipTurnsBeyondItsRest) {
  std::vector<FrameMetrics> frames(6);
  const double tips[] = {0, 80, 95, 88, 91, 90};
  for (int i = 0; i < 6; ++i) frames[i].tip_angle = tips[i];
  EXPECT_EQ(summarize(frames, r, {{2, 5}}).overshoot, 5);
  for (FrameMetrics& m : frames) m.tip_angle = 100 - m.tip_angle;  // the other way round
  EXPECT_EQ(summarize(frames, r, {{2, 5}}).overshoot, 5);
  EXPECT_TRUE(std::isnan(summarize(frames, r, {{0, 5}}).overshoot));
  for (FrameMetrics& m : frames) m.tip_angle = not_measured;
  EXPECT_TRUE(std::isnan(summarize(frames, r, {{2, 5}}).overshoot));
}

TEST(Summary, DriftIsTheLargestChangeOfMomentum) {
  std::vector<FrameMetrics> frames(3);
  for (int i = 0; i < 3; ++i) {
    frames[i].momentum_x = 1 + 3 * (i == 1);
    frames[i].momentum_y = 4 * (i == 1);
    frames[i].momentum_z = 7;
  }
  const Summary summary = summarize(frames, r);
  EXPECT_EQ(summary.momentum_drift, 5);
  EXPECT_TRUE(std::isnan(summary.angular_momentum_drift));
}

TEST(Summary, RefusesARunWithoutFrames) { EXPECT_THROW(summarize({}, r), Error); }

std::vector<RigidFrame> pose(double angle) {
  return {{Vec3::Zero(), Mat3::Identity()}, {Vec3::UnitZ(), turned(angle, Vec3::UnitX())}};
}

TEST(Settling, HoldsAreTheStretchesInWhichNoBoneMoves) {
  std::vector<std::vector<RigidFrame>> poses;
  for (const double angle : {0., 0., 0., 30., 60., 90., 90., 90., 90., 60., 60., 0.})
    poses.push_back(pose(angle));
  const std::vector<Hold> found = holds(poses, r);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].first, 0u);
  EXPECT_EQ(found[0].last, 2u);
  EXPECT_EQ(found[1].first, 5u);
  EXPECT_EQ(found[1].last, 8u);
}

TEST(Settling, ASlowCreepIsNoHold) {
  std::vector<std::vector<RigidFrame>> poses;
  for (int i = 0; i < 30; ++i) poses.push_back(pose(0.006 * i));
  EXPECT_TRUE(holds(poses, r).empty());
}

TEST(Settling, TakesUntilTheBodyStaysNearItsEnd) {
  const std::vector<double> times{0, 1, 2, 3, 4, 5};
  const std::vector<double> away{9, 0.1, 0.21, 0.19, 0.1, 0};  // radii; back out once at 2 s
  const auto positions = [&](std::size_t i) { return Points(7, Vec3(away[i] * r, 1, 2)); };
  EXPECT_EQ(settling_time({1, 5}, times, r, positions), 2);
  EXPECT_EQ(settling_time({3, 5}, times, r, positions), 0);
}

TEST(Settling, BeginsWithTheHoldHoweverEarlyTheFleshWasThere) {
  const std::vector<double> times{0, 1, 2, 3};
  const auto still = [](std::size_t) { return Points(7, Vec3(1, 2, 3)); };
  EXPECT_EQ(settling_time({2, 3}, times, r, still), 0);
  EXPECT_EQ(settling_time({0, 3}, times, r, still), 0);
}

TEST(Settling, TheLongestSettlingOfAllHoldsIsTheRuns) {
  const std::vector<FrameMetrics> frames(4);
  EXPECT_EQ(summarize(frames, r, {{0, 1, 0.1}, {1, 2, 0.4}, {2, 3, 0.2}}).settling_time, 0.4);
  EXPECT_TRUE(std::isnan(summarize(frames, r).settling_time));
}

}  // namespace sinew::test::summary_test
