// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/moments.h>

#include <gtest/gtest.h>

#include <sinew/mesh/clean.h>
#include "mesh/shapes.h"

namespace sinew::moments_test {

TEST(Moments, OfABoxAreThoseOfTextbooks) {
  const Vec3 low(100, 2, -3), size(1, 2, 4);
  const Moments found = moments_of(clean(shapes::box(low, low + size)).triangles);
  EXPECT_NEAR(found.volume, 8, 1e-12);
  EXPECT_LT((found.center - (low + size / 2)).norm(), 1e-12);
  const Vec3 expected = 8.0 / 12 * Vec3(4 + 16, 1 + 16, 1 + 4);
  EXPECT_LT((found.inertia - Mat3(expected.asDiagonal())).norm(), 1e-11);
  EXPECT_LT((found.principal() - Vec3(expected.z(), expected.y(), expected.x())).norm(), 1e-11);
}

TEST(Moments, OfParticlesCountEachAsABall) {
  const Moments one = moments_of(particles_at({Vec3(1, 2, 3)}, 0.1, 1), 4 * pi / 3);
  EXPECT_LT((one.inertia - 0.4 * 4 * pi / 3 * Mat3::Identity()).norm(), 1e-12);
  const Moments two = moments_of(particles_at({Vec3(-3, 0, 0), Vec3(3, 0, 0)}, 0.1, 1), 1);
  EXPECT_NEAR(two.inertia(1, 1) - two.inertia(0, 0), 18, 1e-12);
  EXPECT_EQ(two.center, Vec3(0, 0, 0));
}

}  // namespace sinew::moments_test
