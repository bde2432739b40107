// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/limits.h>

#include <gtest/gtest.h>

#include <sinew/core/error.h>
#include "metrics/world.h"

namespace sinew::test::limits_test {

std::vector<FrameMetrics> frames_with(std::initializer_list<double> volume_errors) {
  std::vector<FrameMetrics> frames;
  for (const double value : volume_errors) {
    frames.emplace_back();
    frames.back().time = static_cast<double>(frames.size());
    frames.back().volume_error = value;
  }
  return frames;
}

Check checked(const std::string& expression, const std::vector<FrameMetrics>& frames) {
  return check_limit(parse_limit(expression), frames, summarize(frames, r));
}

TEST(Limits, TheWorstFrameDecides) {
  struct Case {
    const char* expression;
    bool pass;
    double value;
  };
  const auto frames = frames_with({0.02, 0.08, 0.045, 0.06});
  for (const auto& [expression, pass, value] :
       std::initializer_list<Case>{{"volume_error > 0.05", false, 0.08},
                                   {"volume_error > 0.08", true, 0.08},
                                   {"volume_error >= 0.08", false, 0.08},
                                   {"volume_error < 0.03", false, 0.02},
                                   {"volume_error < 0.02", true, 0.02},
                                   {"volume_error <= 0.02", false, 0.02},
                                   {"volume_error == 0.045", false, 0.045},
                                   {"volume_error == 0.03", true, 0.02},
                                   {"final(volume_error) > 0.05", false, 0.06},
                                   {"final(volume_error) > 0.07", true, 0.06},
                                   {"max(volume_error) > 0.07", false, 0.08},
                                   {"max(volume_error) < 0.1", false, 0.08},
                                   {"min(volume_error) > 0.01", false, 0.02},
                                   {"min(volume_error) > 0.03", true, 0.02},
                                   {"mean(volume_error) >= 0.051", false, 0.05125},
                                   {"mean(volume_error) > 0.052", true, 0.05125},
                                   {"  volume_error>5e-2\t", false, 0.08},
                                   {"max ( volume_error )>=-1", false, 0.08}}) {
    const Check check = checked(expression, frames);
    EXPECT_EQ(check.pass, pass) << expression;
    EXPECT_NEAR(check.value, value, 1e-15) << expression;
  }
}

TEST(Limits, NameTheFrameThatDecides) {
  const auto frames = frames_with({0.02, 0.08, 0.04});
  EXPECT_EQ(checked("volume_error > 0.05", frames).frame, 1u);
  EXPECT_EQ(checked("volume_error < 0.05", frames).frame, 0u);
  EXPECT_EQ(checked("final(volume_error) < 0.05", frames).frame, 2u);
  EXPECT_FALSE(checked("mean(volume_error) < 0.05", frames).frame);
}

TEST(Limits, WhatWasNotMeasuredIsNeverKept) {
  const auto frames = frames_with({0.1, not_measured});
  EXPECT_FALSE(checked("J_min < -100", frames).pass);
  EXPECT_FALSE(checked("final(volume_error) > 1", frames).pass);
  EXPECT_TRUE(checked("volume_error > 1", frames).pass);
  EXPECT_EQ(describe(checked("J_min < -100", frames)), "J_min < -100: fails, it was not measured");
}

TEST(Limits, ReachTheMetricsOfTheWholeRun) {
  const auto frames = frames_with({0.1});
  Summary summary = summarize(frames, r);
  summary.residual_rms = 0.003;
  EXPECT_FALSE(check_limit(parse_limit("residual_rms > 0.002"), frames, summary).pass);
  EXPECT_TRUE(check_limit(parse_limit("residual_rms > 0.004"), frames, summary).pass);
}

TEST(Limits, DescribeThemselvesInOneLine) {
  const auto frames = frames_with({0.125, 0.5});
  EXPECT_EQ(describe(checked(" max(volume_error)>0.25 ", frames)),
            "max(volume_error) > 0.25: fails with 0.5 in frame 1");
  EXPECT_EQ(describe(checked("volume_error > 0.75", frames)),
            "volume_error > 0.75: kept with 0.5 in frame 1");
}

std::string message(const std::string& expression) {
  try {
    parse_limit(expression);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::bad_input);
    return error.what();
  }
  ADD_FAILURE() << "accepted: " << expression;
  return "";
}

TEST(Limits, AnUnknownMetricIsAnsweredWithTheNearestName) {
  EXPECT_NE(message("volume_eror > 1").find("did you mean volume_error?"), std::string::npos);
  EXPECT_NE(message("max(Jmin) < 1").find("did you mean J_min?"), std::string::npos);
  EXPECT_NE(message("residul_rms > 1").find("did you mean residual_rms?"), std::string::npos);
  EXPECT_NE(message("beauty > 1").find("use a column of metrics.csv"), std::string::npos);
}

TEST(Limits, HostileExpressionsAreBadInputInOneLine) {
  const std::string long_name(1 << 20, 'x');
  for (const std::string& expression :
       std::initializer_list<std::string>{"",
                                          " ",
                                          ">",
                                          "> 1",
                                          "volume_error",
                                          "volume_error 1",
                                          "volume_error >",
                                          "volume_error > ",
                                          "volume_error = 1",
                                          "volume_error => 1",
                                          "volume_error != 1",
                                          "volume_error >> 1",
                                          "volume_error > 1 2",
                                          "volume_error > 0x10",
                                          "volume_error > nan",
                                          "volume_error > inf",
                                          "volume_error > -inf",
                                          "volume_error > 1e999",
                                          "volume_error > 5%",
                                          "volume_error > 0.05 m",
                                          "0.05 < volume_error",
                                          "median(volume_error) > 1",
                                          "max(volume_error > 1",
                                          "maxvolume_error) > 1",
                                          "max() > 1",
                                          "max(max(volume_error)) > 1",
                                          "(volume_error) > 1",
                                          "max(J_min)x > 1",
                                          "volume_error > 1 && J_min < 0",
                                          "a\nb > 1",
                                          "volume_error > 1\n2",
                                          std::string("volume\0error > 1", 16),
                                          "\xff\xfe > 1",
                                          long_name + " > 1",
                                          "volume_error > " + long_name}) {
    const std::string said = message(expression);
    EXPECT_EQ(said.find('\n'), said.npos);
    EXPECT_LT(said.size(), 300u);
  }
}

}  // namespace sinew::test::limits_test
