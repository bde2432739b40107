// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/new/new_scene.h>

#include <gtest/gtest.h>

namespace sinew::guess_test {

TEST(Guess, TakesMetersWhereTheyFit) {
  EXPECT_EQ(guess_unit("a.obj", 1.8).unit, LengthUnit::m);
  EXPECT_EQ(guess_unit("a.stl", 0.3).unit, LengthUnit::m);
  EXPECT_EQ(guess_unit("a.glb", 30).unit, LengthUnit::m);
}

TEST(Guess, TakesMillimetersForPartsAndCentimetersForFigures) {
  EXPECT_EQ(guess_unit("a.stl", 120).unit, LengthUnit::mm);
  EXPECT_EQ(guess_unit("a.ply", 1200).unit, LengthUnit::mm);
  EXPECT_EQ(guess_unit("a.obj", 180).unit, LengthUnit::cm);
  EXPECT_EQ(guess_unit("a.glb", 180).unit, LengthUnit::cm);
}

TEST(Guess, TakesTheAxisInWhichTheBodyStands) {
  const Vec3 wide(1, 1, 1);
  EXPECT_EQ(guess_up("a.obj", Box(Vec3(-1, -1, 0), wide)).up, Axis::z);
  EXPECT_EQ(guess_up("a.obj", Box(Vec3(-1, 0, -1), wide)).up, Axis::y);
  EXPECT_EQ(guess_up("a.obj", Box(Vec3(-1, -1, -1), wide)).up, Axis::z);
  EXPECT_EQ(guess_up("a.glb", Box(Vec3(-1, -1, 0), wide)).up, Axis::y);
}

}  // namespace sinew::guess_test
