// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/intrusions.h>

#include <gtest/gtest.h>

#include "support/world.h"

namespace sinew::intrusions_test {

constexpr double r = 0.01, apart = 0.2, height = 15 * 0.01414213562;  // m

/// Two bars side by side, each on a bone of its own.
Points two_bars() {
  const Points bar = test::fcc_box(7, 7, 15, r);
  Points all = bar;
  for (const Vec3& point : bar) all.push_back(point + Vec3(apart, 0, 0));
  return all;
}

Settings two_bones(double shift, double end_time = 1) {
  Settings settings;
  settings.body.radius = r;
  settings.bones = {{"left", "", Vec3(0, 0, 0), Vec3(0, 0, height)},
                    {"right", "", Vec3(apart, 0, 0), Vec3(apart, 0, height)}};
  KeyDefinition begin, end;
  begin.time = 0, end.time = end_time;
  end.translation = {shift, 0, 0};
  settings.tracks = {test::track("right", {begin, end})};
  settings.tracks[0].interpolation = Interpolation::linear;
  settings.output.interval = 0.05;
  return settings;
}

/// The outer planes of particles are 6 half-planes apart.
constexpr double width = 6 * 0.01414213562;

TEST(Intrusions, DepthIsTheOverlapOfTheSurfaces) {
  for (const double overlap : {1.0, 2.0, 3.5}) {  // radii; surfaces are r outside the outer planes
    const double shift = -(apart - width - 2 * r + overlap * r);
    const Prepared prepared = test::prepared(two_bones(shift), two_bars());
    const auto found = intrusions_of(prepared);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].bones, (std::array<int, 2>{0, 1}));
    EXPECT_NEAR(found[0].depth / r, overlap, 0.7);  // rows lie in the gaps of the others
    EXPECT_NEAR(found[0].deepest, 1, 1e-9);
    EXPECT_GT(found[0].first, 0.3);
    EXPECT_LE(found[0].first, found[0].deepest);
  }
}

TEST(Intrusions, NothingMeetsWhereBarsStayApart) {
  EXPECT_TRUE(intrusions_of(test::prepared(two_bones(-0.05), two_bars())).empty());
}

TEST(Intrusions, AFoldAtAJointIsNone) {
  Settings settings = test::box_scene(49);
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(1, 90)})};
  const Points rest = test::fcc_box(7, 7, 49, r);
  EXPECT_TRUE(intrusions_of(test::prepared(settings, rest)).empty());
  // Far from the joint the halves of a bar that is folded altogether are in each other.
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(1, 178)})};
  const auto found = intrusions_of(test::prepared(settings, rest));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_GT(found[0].depth, 2 * r);
}

TEST(Intrusions, AutomaticPassingTakesWhatIsDeepEnough) {
  Settings deep = two_bones(-0.15), shallow = two_bones(-(apart - width - 2 * r + 0.8 * r));
  deep.contact.pass_through.automatic = shallow.contact.pass_through.automatic = true;
  const Prepared passes = test::prepared(deep, two_bars());
  EXPECT_TRUE(passes.body.pass_through.between(1, 0));
  ASSERT_EQ(passes.passing.size(), 1U);
  const std::string text = intrusions_text(passes.passing, passes.body);
  EXPECT_NE(text.find("'left' and 'right' ("), std::string::npos) << text;
  EXPECT_FALSE(test::prepared(shallow, two_bars()).body.pass_through.any());
}

}  // namespace sinew::intrusions_test
