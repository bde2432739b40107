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
  for (const double longest : {180.0, 700.0, 1900.0})
    EXPECT_EQ(guess_unit("a.glb", longest).unit, LengthUnit::cm) << longest;
}

Points box_points(const Vec3& low, const Vec3& high) {
  Points points;
  for (int i = 0; i < 8; ++i)
    points.emplace_back((i & 1 ? high : low).x(), (i & 2 ? high : low).y(),
                        (i & 4 ? high : low).z());
  return points;
}

TEST(Guess, TakesTheAxisInWhichTheBodyStands) {
  const Vec3 wide(1, 1, 1);
  EXPECT_EQ(guess_up("a.obj", box_points(Vec3(-1, -1, 0), wide)).up, Axis::z);
  EXPECT_EQ(guess_up("a.obj", box_points(Vec3(-1, 0, -1), wide)).up, Axis::y);
  EXPECT_EQ(guess_up("a.stl", box_points(Vec3(-1, -1, -1), wide)).up, Axis::z);
  EXPECT_EQ(guess_up("a.obj", box_points(Vec3(-1, -1, -1), wide)).up, Axis::y);
  EXPECT_EQ(guess_up("a.glb", box_points(Vec3(-1, -1, 0), wide)).up, Axis::y);
}

/// Four feet far apart, and a head that reaches beyond them along one side.
TEST(Guess, TakesTheAxisWithTheFootprint) {
  for (const char* file : {"a.obj", "a.ply"})
    for (const Axis up : {Axis::y, Axis::z}) {
      Points points = {{1, 1, 3}, {4, 1, 3}, {1, 4, 3}, {4, 4, 3},
                       {2, 2, 9}, {3, 2, 9}, {2, 3, 9}, {3, 6, 9}};
      if (up == Axis::y)
        for (Vec3& point : points) point = Vec3(point.y(), point.z(), point.x());
      EXPECT_EQ(guess_up(file, points).up, up) << file;
    }
}

}  // namespace sinew::guess_test
