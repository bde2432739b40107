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

}  // namespace sinew::camera_test
