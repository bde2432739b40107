// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/detail/visible_spheres.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <sinew/render/camera.h>

namespace sinew::visible_spheres_test {

/// A closest-packed block of spheres of radius 1, shaken by up to `noise` (m).
Points block(int side, double noise) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-noise, noise);
  Points centers;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int k = 0; k < side; ++k)
        if ((i + j + k) % 2 == 0)
          centers.push_back(std::sqrt(2) * Vec3(i, j, k) +
                            Vec3(shift(random), shift(random), shift(random)));
  return centers;
}

/// The sphere that a ray along the view meets first, -1 for none.
std::ptrdiff_t first_met(const Points& seen, double x, double y) {
  std::ptrdiff_t first = -1;
  double nearest = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double left = 1 - std::pow(seen[i].x() - x, 2) - std::pow(seen[i].y() - y, 2);
    if (left <= 0) continue;
    const double reach = seen[i].z() + std::sqrt(left);
    if (first >= 0 && reach <= nearest) continue;
    first = static_cast<std::ptrdiff_t>(i);
    nearest = reach;
  }
  return first;
}

TEST(VisibleSpheres, AreAllThatAnyRayMeetsAndFewOfALargeBlock) {
  for (const double noise : {0.0, 0.3})
    for (const Mat3& view : {three_quarter_view(), view_from_above(), view_from({1, 0.2, 0})}) {
      const Points centers = block(20, noise);
      const std::vector<std::size_t> visible = visible_spheres(centers, 1, view);
      EXPECT_TRUE(std::is_sorted(visible.begin(), visible.end()));
      const bool aligned = view != three_quarter_view();  // its layers leave holes of no size
      EXPECT_LE(visible.size(), aligned || noise > 0 ? centers.size() : centers.size() / 3);
      const std::set<std::size_t> shown(visible.begin(), visible.end());
      Points seen;
      Box box;
      for (const Vec3& center : centers) box.extend(seen.emplace_back(view * center));
      std::mt19937 random(2);
      std::uniform_real_distribution<double> along_x(box.min().x(), box.max().x()),
          along_y(box.min().y(), box.max().y());
      for (int ray = 0; ray < 2000; ++ray) {
        const std::ptrdiff_t met = first_met(seen, along_x(random), along_y(random));
        if (met < 0) continue;
        EXPECT_TRUE(shown.count(static_cast<std::size_t>(met))) << met;
      }
    }
}

TEST(VisibleSpheres, BehindAnotherAreHiddenOnlyWhereItCoversThem) {
  const Mat3 view = view_from_above();
  const Points four{{0.4, 0.4, 5}, {-0.4, 0.4, 5}, {0.4, -0.4, 5}, {-0.4, -0.4, 5}};
  Points behind = four, before = four, beside = four;
  behind.emplace_back(0, 0, 0), before.emplace_back(0, 0, 8), beside.emplace_back(0.6, 0, 0);
  EXPECT_EQ(visible_spheres(behind, 1, view), std::vector<std::size_t>({0, 1, 2, 3}));
  EXPECT_EQ(visible_spheres(before, 1, view).back(), 4U);
  EXPECT_EQ(visible_spheres(beside, 1, view).back(), 4U);
  EXPECT_EQ(visible_spheres({}, 1, view), std::vector<std::size_t>());
}

}  // namespace sinew::visible_spheres_test
