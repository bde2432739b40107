// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/new/capsules.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/mesh/clean.h>
#include <sinew/mesh/winding.h>

namespace sinew::capsules_test {

Surface surface_of(const Triangles& skin) {
  PolygonSoup soup{skin.points, {}};
  for (const auto& face : skin.faces) soup.polygons.emplace_back(face.begin(), face.end());
  return clean(soup);
}

TEST(SkinAround, HasTheVolumeOfACapsule) {
  const double r = 0.1, length = 0.5, side = 0.03;
  const Triangles skin = skin_around({{{0, 0, 0}, {length, 0, 0}, r}}, side);
  const Surface surface = surface_of(skin);
  EXPECT_TRUE(surface.closed());
  EXPECT_EQ(surface.components, 1);
  const double volume = pi * r * r * length + 4.0 / 3 * pi * r * r * r;
  EXPECT_NEAR(component_volumes(surface).front(), volume, 0.03 * volume);
  for (const Vec3& point : skin.points)
    EXPECT_NEAR((point - Vec3(std::clamp(point.x(), 0.0, length), 0, 0)).norm(), r, side / 12);
}

TEST(SkinAround, KeepsAGapAsWideAsASide) {
  const double side = 0.02, r = 0.05, apart = 2 * r + side;
  const Vec3 shift(0, apart, 0), end(0, 0, 0.6);
  const Surface surface = surface_of(
      skin_around({{{0, 0, 0}, end, r}, {shift, shift + end, r}, {end, end + shift, r}}, side));
  EXPECT_EQ(surface.components, 1);
  const Winding winding = winding_of(surface);
  for (const double z : {0.0, 0.1, 0.2, 0.3, 0.4})
    EXPECT_EQ(winding.around(shift / 2 + Vec3(0, 0, z)).value_or(9), 0) << z;
  EXPECT_EQ(winding.around(shift / 2 + end).value_or(9), 1);
}

TEST(SkinAround, HoldsPartsApartFromOthers) {
  const Surface surface = surface_of(skin_around({{{0, 0, 0}, {0.5, 0, 0}, 0.1},
                                                  {{0, 1, 0}, {0.5, 1, 0}, 0.03},
                                                  {{3, 1, 0}, {3.1, 1, 0}, 0.03}},
                                                 0.03));
  EXPECT_EQ(surface.components, 3);
  const Winding winding = winding_of(surface);
  for (const Vec3& inside : {Vec3(0.25, 0, 0), Vec3(0.25, 1, 0), Vec3(3.05, 1, 0)})
    EXPECT_EQ(winding.around(inside).value_or(9), 1);
}

TEST(SkinAround, IsTheSameEachTime) {
  const std::vector<Capsule> parts = {{{0, 0, 0}, {0.5, 0, 0}, 0.1},
                                      {{0.5, 0, 0}, {0.7, 0.2, 0}, 0.04}};
  const Triangles once = skin_around(parts, 0.03), again = skin_around(parts, 0.03);
  EXPECT_EQ(once.points, again.points);
  EXPECT_EQ(once.faces, again.faces);
  EXPECT_THROW(skin_around({}, 0.03), Error);
}

}  // namespace sinew::capsules_test
