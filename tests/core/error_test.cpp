// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/error.h>

#include <gtest/gtest.h>

#include <sinew/settings/settings.h>

namespace sinew::error_test {

TEST(Error, GivesPlaceWhatAndCureInOneLine) {
  const Error error = bad_input({"a.yaml", 3, 7}, "it is wrong", "right it");
  EXPECT_STREQ(error.what(), "a.yaml:3:7: it is wrong; right it");
  EXPECT_EQ(error.exit(), Exit::bad_input);
  EXPECT_STREQ(error.with_context({"b.yaml", 2}).what(),
               "b.yaml:2: a.yaml:3:7: it is wrong; right it");
  EXPECT_STREQ(error.with_context({}).what(), error.what());
  EXPECT_STREQ(not_written("out/x", "the disk is full", "make room").what(),
               "out/x: the disk is full; make room");
  EXPECT_EQ(not_written("", "", "").exit(), Exit::not_written);
}

TEST(Error, NamesItsPlaceOnce) {
  const Error error = bad_input({"a.yaml", 3, 7}, "it is wrong", "right it");
  EXPECT_STREQ(error.with_context({"a.yaml", 2, 1}).what(), error.what());
  const Error through = error.with_context({"b.yaml", 2});
  EXPECT_STREQ(through.with_context({"b.yaml", 1}).what(), through.what());
}

TEST(Error, IsWholeWhateverNamesHold) {
  const std::string name("run\0x", 5);
  EXPECT_STREQ(bad_input({name}, "it is wrong", "right it").what(), "run?x: it is wrong; right it");
}

TEST(Place, LeavesOutWhatIsUnknown) {
  EXPECT_EQ((Place{"a.yaml", 3, 7}.text()), "a.yaml:3:7");
  EXPECT_EQ((Place{"a.yaml", 3, 0}.text()), "a.yaml:3");
  EXPECT_EQ((Place{"a.yaml", 0, 7}.text()), "a.yaml");
  EXPECT_EQ((Place{"", 3, 7}.text()), "");
}

TEST(Settings, FindThePlaceOfTheNearestEnclosingPath) {
  Settings settings;
  settings.places = {{"", {"s.yaml", 1, 1}},
                     {"skeleton.bones", {"s.yaml", 4, 1}},
                     {"skeleton.bones[1]", {"s.yaml", 8, 3}},
                     {"skeleton.bones[1].tail", {"s.yaml", 9, 5}}};
  EXPECT_EQ(settings.place("skeleton.bones[1].tail").line, 9);
  EXPECT_EQ(settings.place("skeleton.bones[1].parent").line, 8);
  EXPECT_EQ(settings.place("skeleton.bones[2].parent").line, 4);
  EXPECT_EQ(settings.place("solver.gravity").line, 1);
  EXPECT_EQ(Settings().place("body.mesh").text(), "");
}

}  // namespace sinew::error_test
