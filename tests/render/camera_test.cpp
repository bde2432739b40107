// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/camera.h>

#include <cmath>
#include <limits>

#include "helpers.h"

namespace sinew::camera_test {

TEST(Camera, view_is_a_rotation_with_z_upwards) {
  const Mat3 view = three_quarter_view();
  EXPECT_NEAR((view * view.transpose() - Mat3::Identity()).norm(), 0, 1e-12);
  EXPECT_NEAR(view.determinant(), 1, 1e-12);
  const Vec3 z = view * Vec3::UnitZ();
  EXPECT_NEAR(z.x(), 0, 1e-12);
  EXPECT_GT(z.y(), 0.9);
}

TEST(Camera, sees_spheres_in_full) {
  Snapshot snapshot;
  snapshot.particles = {{1, 2, 3}};
  snapshot.radius = 0.5;
  const Box box = seen(view_from({0, -1, 0}), snapshot);
  EXPECT_NEAR((box.min() - Vec3(0.5, 2.5, -2.5)).norm(), 0, 1e-12);
  EXPECT_NEAR((box.max() - Vec3(1.5, 3.5, -1.5)).norm(), 0, 1e-12);
}

TEST(Camera, refuses_positions_that_are_not_finite) {
  Snapshot snapshot;
  snapshot.surface.points = {{0, std::numeric_limits<double>::quiet_NaN(), 0}};
  EXPECT_EQ(error_of([&] { seen(three_quarter_view(), snapshot); }).exit(), Exit::bad_input);
}

TEST(Camera, the_tighter_side_decides_the_scale) {
  const Box frame(Vec3(0, 0, 0), Vec3(2, 1, 5));
  EXPECT_DOUBLE_EQ(meters_per_pixel(frame, 100, 100), 0.02);
  EXPECT_DOUBLE_EQ(meters_per_pixel(frame, 400, 100), 0.01);
}

Snapshot two_points() {
  Snapshot snapshot;
  snapshot.particles = {{1, 0, 0}, {3, 4, 2}};
  snapshot.radius = 0.5;
  return snapshot;
}

TEST(Camera, orbits_about_an_upright_cylinder_that_holds_everything) {
  Cylinder around{{1, 0, 0.5}, 0, 0, 0};
  around.extend(two_points());
  EXPECT_NEAR(around.radius, std::hypot(2, 4) + 0.5, 1e-12);
  EXPECT_NEAR(around.low, -1, 1e-12);
  EXPECT_NEAR(around.high, 2, 1e-12);
  const Vec3 size = orbiting(around, three_quarter_view(), 0).frame.sizes();
  for (double angle = -7; angle < 7; angle += 0.37) {
    const Camera camera = orbiting(around, three_quarter_view(), angle);
    EXPECT_NEAR((camera.frame.sizes() - size).norm(), 0, 1e-12);  // the same scale at all times
    EXPECT_TRUE(camera.frame.contains(seen(camera.view, two_points())));
  }
}

TEST(Camera, orbits_counterclockwise_seen_from_above) {
  const Mat3 view = orbiting({}, view_from({0, -1, 0}), pi / 2).view;
  EXPECT_NEAR((view - view_from({1, 0, 0})).norm(), 0, 1e-12);
  EXPECT_NEAR((orbiting({}, view, 2 * pi).view - view).norm(), 0, 1e-12);
}

TEST(Camera, cylinders_of_two_runs_lie_in_that_of_both) {
  Cylinder one{{1, 0, 0.5}, 2, -1, 1};
  one.extend(Cylinder{{4, 4, 1.5}, 3, -3, 5});
  EXPECT_NEAR(one.radius, 5 + 3, 1e-12);
  EXPECT_NEAR(one.low, -2, 1e-12);
  EXPECT_NEAR(one.high, 6, 1e-12);
}

}  // namespace sinew::camera_test
