// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/chart.h>

#include <gtest/gtest.h>

#include <cmath>

#include <sinew/metrics/report/axis.h>
#include <sinew/metrics/report/markup.h>

namespace sinew::test {
namespace {

TEST(Axis, TicksAreRoundAndEncloseTheValues) {
  const Axis axis = round_axis(0.03, 0.92, 4);
  EXPECT_EQ(axis.low, 0);
  EXPECT_EQ(axis.high, 1);
  EXPECT_EQ(axis.texts, (std::vector<std::string>{"0", "0.5", "1.0"}));
  EXPECT_EQ(round_axis(-3, 7, 5).texts,
            (std::vector<std::string>{"-4", "-2", "0", "2", "4", "6", "8"}));
}

TEST(Axis, GivesAllItsNumbersAsManyDecimalsUnlessTheyAreVerySmallOrLarge) {
  EXPECT_EQ(tight_axis(0, 1.1e-3, 4).texts.back(), "0.0010");
  EXPECT_EQ(tight_axis(0, 0.9e-3, 2).texts.back(), readable(5e-4));
  EXPECT_EQ(tight_axis(0, 1.1e5, 2).texts.back(), readable(1e5));
  EXPECT_EQ(tight_axis(0, 0.9e5, 4).texts.back(), "50000");
}

TEST(Axis, TightOnesEndWhereTheValuesDo) {
  const Axis axis = tight_axis(0, 2.9, 6);
  EXPECT_EQ(axis.high, 2.9);
  EXPECT_EQ(axis.texts, (std::vector<std::string>{"0", "0.5", "1.0", "1.5", "2.0", "2.5"}));
}

TEST(Axis, AFlatCurveLiesInTheMiddle) {
  const Axis axis = tight_axis(2000, 2000, 4);
  EXPECT_DOUBLE_EQ(axis.low, 1999);
  EXPECT_DOUBLE_EQ(axis.high, 2001);
}

TEST(Axis, HoldsForEveryRange) {
  for (const double size : {0.0, 1e-300, 1e-12, 1.0, 1e9, 1e299})
    for (const double offset : {0.0, size, -size, 1e6 * size}) {
      const Axis axis = round_axis(offset, offset + size, 4);
      EXPECT_LT(axis.low, axis.high) << size << ' ' << offset;
      EXPECT_LE(axis.low, offset + 1e-9 * size);
      EXPECT_GE(axis.ticks.size(), 2u);
      EXPECT_LE(axis.ticks.size(), 12u);
    }
}

TEST(Axis, PlacesValuesInProportion) {
  const Axis axis{10, 20, {}, {}};
  EXPECT_EQ(place_on(axis, 10, 100, 0), 100);
  EXPECT_EQ(place_on(axis, 15, 100, 0), 50);
  EXPECT_EQ(place_on(axis, 20, 100, 0), 0);
}

TEST(Markup, NumbersHaveFourDigitsForReading) {
  EXPECT_EQ(readable(0), "0");
  EXPECT_EQ(readable(1), "1");
  EXPECT_EQ(readable(-0.0123456), "-0.01235");
  EXPECT_EQ(readable(1234.56), "1235");
  EXPECT_EQ(readable(98765.4), "98765");
  EXPECT_EQ(readable(1.5e-7), "1.500e-07");
  EXPECT_EQ(readable(100), "100");
  EXPECT_EQ(readable(std::nan("")), "–");
}

TEST(Markup, TextCannotLeaveItsElement) {
  EXPECT_EQ(escaped("<a href=\"x\">&'"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
  EXPECT_EQ(escaped(std::string("a\0b\x1b[31m\n", 9)), "ab[31m\n");
  EXPECT_EQ(escaped("Gänsefuß"), "Gänsefuß");
}

TEST(Markup, LinksStayRelative) {
  EXPECT_EQ(link_to("pictures/a b.png"), "pictures/a%20b.png");
  EXPECT_EQ(link_to("//host/x"), "host/x");
  EXPECT_EQ(link_to("javascript:x"), "javascript%3Ax");
  EXPECT_EQ(link_to("a?b#c%d\"e"), "a%3Fb%23c%25d%22e");
}

Chart ramp() {
  Chart chart;
  chart.title = "Ramp";
  chart.times = {0, 1, 2};
  chart.lines = {{"ramp", {0, 0.5, 1}}};
  chart.baselines = {0};
  return chart;
}

TEST(Chart, ARampRunsFromCornerToCorner) {
  EXPECT_NE(chart_html(ramp()).find("d=\"M50.0 176.0L239.0 93.0L428.0 10.0\""), std::string::npos);
}

TEST(Chart, AGapBreaksTheLine) {
  Chart chart = ramp();
  chart.times = {0, 1, 2, 3, 4};
  chart.lines[0].values = {0, 1, std::nan(""), 1, INFINITY};
  EXPECT_NE(chart_html(chart).find("d=\"M50.0 176.0L144.5 10.0M333.5 10.0\""), std::string::npos);
}

TEST(Chart, ThinningKeepsThePeak) {
  Chart chart = ramp();
  chart.times.clear();
  chart.lines[0].values.assign(100000, 0.0);
  for (int i = 0; i < 100000; ++i) chart.times.push_back(i);
  chart.lines[0].values[70001] = 1;
  const std::string html = chart_html(chart);
  EXPECT_LT(html.size(), 30000u);
  EXPECT_NE(html.find("L314.6 10.0L"), std::string::npos);  // 0.70001 of the way, at the top
}

TEST(Chart, BonesShowBeneathOnlyWhereThereAreBones) {
  Chart chart = ramp();
  EXPECT_EQ(chart_html(chart).find("bones"), std::string::npos);
  chart.angles = {0, 45, 90};
  EXPECT_NE(chart_html(chart).find(">90°<"), std::string::npos);
  chart.angles = {std::nan(""), std::nan(""), std::nan("")};
  EXPECT_EQ(chart_html(chart).find("bones"), std::string::npos);
}

}  // namespace
}  // namespace sinew::test
