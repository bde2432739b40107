// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <limits>

#include <sinew/scene/rig.h>
#include <sinew/world/region.h>
#include <sinew/world/shapes.h>

#include "support/expect_error.h"
#include "support/world.h"

namespace sinew::world_shapes_test {

BoxShape tilted_box() { return {{0.1, -0.2, 0.3}, {0.5, 0.3, 0.8}, test::turned({1, 2, 3}, 40)}; }
const SphereShape sphere = {{0.2, 0.1, -0.1}, 0.7};
const CapsuleShape capsule = {{-0.4, 0, 0.1}, {0.5, 0.3, -0.2}, 0.3};
const PlaneShape plane = {{0, 0.1, 0}, {1, 2, -2}};

MeshShape meshed(const SphereShape& solid) {
  const Vec3 reach = Vec3::Constant(solid.radius);
  return {[solid](const Vec3& p) { return signed_distance(solid, p); },
          Box(solid.center - reach, solid.center + reach)};
}

std::vector<Shape> all_shapes() { return {plane, sphere, capsule, tilted_box(), meshed(sphere)}; }

/// n x n points on the six faces.
Points sampled(const BoxShape& box, int n) {
  Points points;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
          Vec3 local;
          local[axis] = side;
          local[(axis + 1) % 3] = 2.0 * i / n - 1;
          local[(axis + 2) % 3] = 2.0 * j / n - 1;
          points.push_back(box.center + box.rotation * local.cwiseProduct(box.half));
        }
  return points;
}

/// Points all over a sphere, or over the spheres along a capsule's segment (those inside as well).
Points sampled(const CapsuleShape& solid, int n) {
  Points points;
  for (int k = 0; k <= n; ++k)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j < 2 * n; ++j) {
        const double polar = pi * i / n, around = pi * j / n;
        const Vec3 unit(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                        std::cos(polar));
        points.push_back(solid.a + double(k) / n * (solid.b - solid.a) + solid.radius * unit);
      }
  return points;
}

double nearest(const Points& points, const Vec3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& other : points) least = std::min(least, (other - point).squaredNorm());
  return std::sqrt(least);
}

/// No sample of the surface is nearer than the distance, and one is within `spacing` of it.
void expect_sampled(const Shape& shape, const Points& surface, double spacing, bool outside_only) {
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j)
      for (int k = -3; k <= 3; ++k) {
        const Vec3 point = 0.37 * Vec3(i, j, k);
        const double distance = signed_distance(shape, point).distance;
        if (outside_only && distance < 0) continue;
        const double found = nearest(surface, point);
        EXPECT_GE(found, std::abs(distance) - 1e-12) << point.transpose();
        EXPECT_LE(found, std::abs(distance) + spacing) << point.transpose();
      }
}

TEST(WorldShapes, DistancesAgreeWithSampledSurfaces) {
  expect_sampled(tilted_box(), sampled(tilted_box(), 40), 0.03, false);
  expect_sampled(sphere, sampled(CapsuleShape{sphere.center, sphere.center, sphere.radius}, 30),
                 0.06, false);
  expect_sampled(capsule, sampled(capsule, 24), 0.06, true);
}

TEST(WorldShapes, InsideIsWhereTheDefinitionSaysSo) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 p = 2 * test::random_vector(random);
    const BoxShape box = tilted_box();
    const Vec3 local = box.rotation.transpose() * (p - box.center);
    EXPECT_EQ(signed_distance(box, p).distance < 0, (local.array().abs() < box.half.array()).all());
    EXPECT_EQ(signed_distance(sphere, p).distance < 0, (p - sphere.center).norm() < sphere.radius);
    EXPECT_EQ(signed_distance(plane, p).distance < 0, (p - plane.point).dot(plane.normal) < 0);
  }
}

// The law of a signed distance: the surface is one distance back along the normal, and no distance
// changes faster than the position.
TEST(WorldShapes, TheFootOfEveryPointLiesOnTheSurface) {
  std::mt19937 random(1);
  for (const Shape& shape : all_shapes())
    for (int trial = 0; trial < 500; ++trial) {
      const Vec3 p = 3 * test::random_vector(random), q = p + 0.3 * test::random_vector(random);
      const SignedDistance at_p = signed_distance(shape, p), at_q = signed_distance(shape, q);
      EXPECT_NEAR(at_p.normal.norm(), 1, 1e-14);
      EXPECT_NEAR(signed_distance(shape, p - at_p.distance * at_p.normal).distance, 0, 1e-14);
      EXPECT_LE(std::abs(at_p.distance - at_q.distance), (p - q).norm() + 1e-14);
    }
}

TEST(WorldShapes, NormalsAreTheGradientOfTheDistance) {
  std::mt19937 random(2);
  const double h = 1e-6;
  int tested = 0;
  for (const Shape& shape : all_shapes())
    for (int trial = 0; trial < 200; ++trial) {
      const Vec3 p = 3 * test::random_vector(random);
      Vec3 slope, curvature;
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = h * Vec3::Unit(axis);
        const double up = signed_distance(shape, p + step).distance;
        const double down = signed_distance(shape, p - step).distance;
        slope[axis] = (up - down) / (2 * h);
        curvature[axis] = std::abs(up + down - 2 * signed_distance(shape, p).distance);
      }
      if (curvature.maxCoeff() > 1e-8) continue;  // two faces are equally near
      ++tested;
      EXPECT_NEAR((slope - signed_distance(shape, p).normal).norm(), 0, 1e-5);
    }
  EXPECT_GT(tested, 900);
}

TEST(WorldShapes, PlacesWithoutOneNearestPointHaveANormalAllTheSame) {
  const CapsuleShape point = {{1, 2, 3}, {1, 2, 3}, 0.5};
  const Vec3 middle = (capsule.a + capsule.b) / 2;
  const std::vector<std::pair<Shape, Vec3>> places = {
      {sphere, sphere.center}, {tilted_box(), tilted_box().center},
      {capsule, middle},       {capsule, capsule.a},
      {point, point.a},        {CapsuleShape{{0, 0, 0}, {0, 0, 1}, 0.5}, {0, 0, 0.25}}};
  for (const auto& [shape, p] : places) {
    const SignedDistance nearest_point = signed_distance(shape, p);
    EXPECT_LT(nearest_point.distance, 0);
    EXPECT_NEAR(nearest_point.normal.norm(), 1, 1e-14);
    const Vec3 foot = p - nearest_point.distance * nearest_point.normal;
    EXPECT_NEAR(signed_distance(shape, foot).distance, 0, 1e-9);
  }
}

TEST(WorldShapes, ACapsuleWithoutLengthIsASphere) {
  const CapsuleShape point = {sphere.center, sphere.center, sphere.radius};
  std::mt19937 random(4);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3 p = 3 * test::random_vector(random);
    EXPECT_EQ(signed_distance(point, p).distance, signed_distance(sphere, p).distance);
    EXPECT_EQ(signed_distance(point, p).normal, signed_distance(sphere, p).normal);
  }
}

TEST(WorldShapes, AMeshIsNotEvaluatedFarFromIt) {
  const Shape mesh = meshed(sphere);
  const Vec3 beside = sphere.center + Vec3(sphere.radius + 0.1, 0, 0);
  EXPECT_TRUE(may_be_within(mesh, beside, 0.11));
  EXPECT_FALSE(may_be_within(mesh, beside, 0.09));
  EXPECT_TRUE(may_be_within(mesh, sphere.center, 1e-9));
  EXPECT_TRUE(may_be_within(sphere, beside, 1e-9));  // cheap enough to evaluate
}

/// The least distance of points all over a box.
double min_distance(const Shape& shape, const Box& box, int n) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) {
        const Vec3 at = Vec3(i, j, k).cwiseProduct(box.sizes()) / n;
        least = std::min(least, signed_distance(shape, box.min() + at).distance);
      }
  return least;
}

TEST(WorldShapes, NoBoxWithPointsInRangeIsMissed) {
  std::mt19937 random(9);
  for (const Shape& shape : all_shapes())
    for (int trial = 0; trial < 300; ++trial) {
      const Vec3 center = 2 * test::random_vector(random);
      const Vec3 half = test::random_vector(random).cwiseAbs();
      const Box box(Vec3(center - half), Vec3(center + half));
      const double least = min_distance(shape, box, 6);
      EXPECT_TRUE(may_be_near(shape, box, std::max(0.0, least) + 1e-9)) << shape.index();
    }
}

TEST(WorldShapes, LongBoxesBesideAPlaneOrASphereAreTold) {
  const PlaneShape ground{{0, 0, 0.1}, {0, 0, 2}};
  const Box row(Vec3(-5, 0, 0.3), Vec3(5, 0.1, 0.4));
  EXPECT_FALSE(may_be_near(ground, row, 0.19));
  EXPECT_TRUE(may_be_near(ground, row, 0.21));
  const SphereShape ball{{0, 0, -1}, 1};
  EXPECT_FALSE(may_be_near(ball, row, 0.29));
  EXPECT_TRUE(may_be_near(ball, row, 0.31));
}

TEST(WorldShapes, BadShapesAreRefused) {
  const auto refused = [](const Shape& shape, const std::string& why) {
    test::expect_bad_input([&] { check_shape(shape, "it"); }, {why});
  };
  refused(PlaneShape{{0, 0, 0}, {0, 0, 0}}, "it is a plane whose normal has no length");
  refused(SphereShape{{0, 0, 0}, 0}, "it has a radius of 0");
  refused(SphereShape{{0, NAN, 0}, 1}, "not finite");
  refused(CapsuleShape{{0, 0, 0}, {0, 0, 1}, -1}, "it has a radius of -1");
  refused(BoxShape{{0, 0, 0}, {1, 0, 1}}, "it has a half edge of 0");
  refused(BoxShape{{0, 0, 0}, {1, 1, 1}, 2 * Mat3::Identity()}, "axes are not square");
  refused(MeshShape{}, "mesh without distances");
  MeshShape mesh = meshed(sphere);
  for (Vec3* corner : {&mesh.bounds.min(), &mesh.bounds.max()})
    for (const double nowhere : {HUGE_VAL, -HUGE_VAL, static_cast<double>(NAN)}) {
      const double before = std::exchange(corner->y(), nowhere);
      refused(mesh, "mesh without bounds");
      corner->y() = before;
    }
  for (const Shape& shape : all_shapes()) EXPECT_NO_THROW(check_shape(shape, "it"));
}

TEST(WorldShapes, ARegionFadesOverItsEdge) {
  const Region soft = {SphereShape{{0, 0, 0}, 1}, 0.5}, sharp = {SphereShape{{0, 0, 0}, 1}, 0};
  EXPECT_EQ(soft.weight({0.9, 0, 0}), 1);
  EXPECT_EQ(soft.weight({1, 0, 0}), 1);
  EXPECT_NEAR(soft.weight({1.25, 0, 0}), 0.5, 1e-15);
  EXPECT_NEAR(soft.weight({1.125, 0, 0}), 0.84375, 1e-15);
  EXPECT_EQ(soft.weight({1.5, 0, 0}), 0);
  EXPECT_EQ(sharp.weight({1, 0, 0}), 1);
  EXPECT_EQ(sharp.weight({1.0001, 0, 0}), 0);
  EXPECT_EQ(Region{}.weight({1e9, 0, 0}), 1);
  const Region mesh = {meshed({{0, 0, 0}, 1}), 0.5};
  for (const double x : {0.5, 1.0, 1.2, 1.4, 1.6})
    EXPECT_EQ(mesh.weight({x, 0, 0}), soft.weight({x, 0, 0}));
  test::expect_bad_input([&] { check_region({sphere, -1}, "it"); }, {"it has a falloff of -1"});
}

}  // namespace sinew::world_shapes_test
