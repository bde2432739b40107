// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/skin.h>

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/scene/rig.h>

#include "support/world.h"

namespace sinew::skin_test {

using test::affine;
using test::turned;

constexpr double r = 0.01;

/// Vertices in and around the box of the points, up to `beyond` outside.
Points vertices_around(const Points& points, double beyond, int count = 300) {
  std::mt19937 random(5);
  Box box;
  for (const Vec3& point : points) box.extend(point);
  const Vec3 size = box.sizes() + Vec3::Constant(2 * beyond);
  Points vertices;
  for (int i = 0; i < count; ++i)
    vertices.push_back(box.center() + size.cwiseProduct(test::random_vector(random)));
  return vertices;
}

/// The largest error when the body, vertices around it, and all, move by F and a shift.
double error_under(const Points& points, const Mat3& F, const Vec3& shift) {
  const Points vertices = vertices_around(points, 2 * r);
  const Points expected = affine(vertices, F, shift);
  const Points found = follow(make_skin(vertices, points, r), affine(points, F, shift));
  double most = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    most = std::max(most, (found[i] - expected[i]).norm());
  return most;
}

TEST(Skin, FollowsAffineMotionExactly) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 10; ++trial) {
    const Mat3 F = Mat3::Identity() + 0.5 * test::random_matrix(random);
    EXPECT_LT(error_under(test::fcc_box(7, 7, 15, r), F, {1, -2, 3}), 1e-10);
  }
}

TEST(Skin, WeightsArePositiveAndAPartitionOfUnity) {
  const Points points = test::fcc_box(5, 5, 9, r);
  const Skin skin = make_skin(vertices_around(points, 30 * r), points, r);
  for (std::size_t i = 0; i < skin.rest.size(); ++i) {
    double sum = 0;
    for (auto k = skin.first[i]; k < skin.first[i + 1]; ++k) {
      EXPECT_GT(skin.weight[k], 0);
      sum += skin.weight[k];
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

/// The weights of the definition: h = max(6 r, 1.05 times the distance of the 20th).
std::vector<double> weights_by_definition(const Vec3& vertex, const Points& points) {
  std::vector<double> distance, weight;
  for (const Vec3& point : points) distance.push_back((point - vertex).norm());
  std::vector<double> sorted = distance;
  std::sort(sorted.begin(), sorted.end());
  const double h = std::max(6 * r, 1.05 * sorted[std::min<std::size_t>(19, sorted.size() - 1)]);
  double sum = 0;
  for (const double s : distance) {
    weight.push_back(s < h ? std::pow(1 - s * s / (h * h), 3) : 0);
    sum += weight.back();
  }
  for (double& w : weight) w /= sum;
  return weight;
}

TEST(Skin, WeightsAreThoseOfTheDefinitionNearAndFar) {
  for (const Points& points : {test::fcc_box(5, 5, 9, r), test::fcc_box(3, 3, 1, r)}) {
    const Skin skin = make_skin(vertices_around(points, 12 * r, 2000), points, r);
    for (std::size_t i = 0; i < skin.rest.size(); ++i) {
      std::vector<double> found(points.size(), 0.0);
      for (auto k = skin.first[i]; k < skin.first[i + 1]; ++k)
        found[skin.near[skin.weighted[skin.particle[k]]]] += skin.weight[k];
      const auto expected = weights_by_definition(skin.rest[i], points);
      for (std::size_t j = 0; j < points.size(); ++j) ASSERT_NEAR(found[j], expected[j], 1e-12);
    }
  }
}

TEST(Skin, OfSmallAndFlatBodiesFollowsRigidMotion) {
  const Points three_by_three = test::fcc_box(3, 3, 3, r);
  for (const Points& points :
       {three_by_three, test::fcc_box(5, 5, 1, r), test::fcc_box(2, 2, 2, r)})
    for (const double angle : {0, 70, 180})
      EXPECT_LT(error_under(points, turned({1, 2, -1}, angle), {1, 1, 1}), 1e-12);
}

TEST(Skin, OfLinesAndSinglePointsRestsAndMovesAlong) {
  Points line;
  for (int i = 0; i < 5; ++i) line.push_back(turned({1, 5, 2}, 33) * Vec3(2 * r * i, 0, 0));
  for (const Points& points : {Points{{1, 2, 3}}, line, Points(line.begin(), line.begin() + 2)}) {
    EXPECT_LT(error_under(points, Mat3::Identity(), {0, 0, 0}), 1e-12);
    EXPECT_LT(error_under(points, Mat3::Identity(), {1, 1, 1}), 1e-12);
  }
}

TEST(Skin, KeepsOnlyTheRotationWhereTheGradientIsUnreliable) {
  const Points points = test::fcc_box(5, 5, 5, r);
  const Points vertices = {points[10] + Vec3(r, 0, 0)};
  const Skin skin = make_skin(vertices, points, r);
  // Ten times as large in all directions: J = 1000 is no gradient to extrapolate with.
  const Points now = follow(skin, affine(points, 10 * Mat3::Identity()));
  Vec3 expected = Vec3::Zero();
  for (auto k = skin.first[0]; k < skin.first[1]; ++k) {
    const Vec3& at_rest = points[skin.near[skin.weighted[skin.particle[k]]]];
    expected += skin.weight[k] * (10 * at_rest + (vertices[0] - at_rest));
  }
  EXPECT_LT((now[0] - expected).norm(), 1e-12);
}

TEST(Skin, KeepsOnlyTheParticlesNearItAndFollowsAsWithAll) {
  const Points points = test::fcc_box(25, 25, 25, r);
  const RestShape body = rest_shape(points, rest_neighbor_range(r));
  const Points vertices = vertices_around(test::fcc_box(5, 5, 5, r), r);
  const Skin skin = make_skin(vertices, points, r);
  EXPECT_LT(skin.near.size(), points.size() / 2);
  Points now;
  for (const Vec3& p : points)
    now.push_back(p + 3 * Vec3(p.y() * p.z(), p.x() * p.x(), p.y() * p.x()));
  const Points found = follow(skin, now);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    Vec3 expected = Vec3::Zero();
    for (auto k = skin.first[i]; k < skin.first[i + 1]; ++k) {
      const std::uint32_t j = skin.near[skin.weighted[skin.particle[k]]];
      const Mat3 F = deformation_gradient(body, now, j);
      expected += skin.weight[k] * (now[j] + F * (vertices[i] - points[j]));
    }
    EXPECT_EQ(found[i], expected);
  }
}

/// Two fingers 2.4 radii apart, or touching, each along a bone of its own.
struct Fingers {
  Points points;
  std::size_t right = 0;  // where the second begins
  Skeleton skeleton;
  Binding binding;

  explicit Fingers(double gap) {
    const double shift = 2 * half_plane_spacing(r) + gap / 2;
    for (const double x : {-shift, shift}) {
      right = points.size();
      for (const Vec3& point : test::fcc_box(5, 5, 15, r)) points.push_back(point + Vec3(x, 0, 0));
    }
    Settings settings;
    settings.bones = {{"left", "", Vec3(-shift, 0, 0), Vec3(-shift, 0, 0.2)},
                      {"right", "", Vec3(shift, 0, 0), Vec3(shift, 0, 0.2)}};
    skeleton = skeleton_of(settings);
    binding = bind_to_bones(points, skeleton, volume_per_particle(r), 0);
  }

  /// How far vertices left of the gap move when the right finger alone moves by one.
  double bleeding(const Skin& skin) const {
    Points now = points;
    for (std::size_t j = right; j < now.size(); ++j) now[j].y() += 1;
    const Points moved = follow(skin, now);
    double most = 0;
    for (std::size_t i = 0; i < moved.size(); ++i)
      if (skin.rest[i].x() < -r) most = std::max(most, (moved[i] - skin.rest[i]).norm());
    return most;
  }
};

TEST(Skin, OfOneFingerDoesNotFollowTheNext) {
  const Fingers fingers(2.4 * r);
  const Points vertices = vertices_around(fingers.points, r);
  EXPECT_GT(fingers.bleeding(make_skin(vertices, fingers.points, r)), 0.1);
  const Skin apart = make_skin(vertices, fingers.points, r, fingers.skeleton, fingers.binding);
  EXPECT_LT(fingers.bleeding(apart), 1e-12);
}

TEST(Skin, OfTouchingPartsIsOne) {
  const Fingers grown(2 * r);
  const Points vertices = vertices_around(grown.points, r);
  const Skin all = make_skin(vertices, grown.points, r);
  const Skin apart = make_skin(vertices, grown.points, r, grown.skeleton, grown.binding);
  EXPECT_EQ(apart.particle, all.particle);
  EXPECT_EQ(apart.weight, all.weight);
}

TEST(Skin, HasTheSameBitsForEveryThreadCount) {
  const Points points = test::fcc_box(11, 11, 25, r);
  const Points vertices = vertices_around(points, 12 * r, 3000);
  const Points moved = affine(points, turned({1, 1, 0}, 20));
  const Skin skin = make_skin(vertices, points, r);
  const Points expected = follow(skin, moved);
  for (const int threads : {1, 2, 3, 8})
    with_threads(threads, [&] {
      const Skin again = make_skin(vertices, points, r);
      EXPECT_EQ(again.first, skin.first);
      EXPECT_EQ(again.particle, skin.particle);
      EXPECT_EQ(again.weight, skin.weight);
      EXPECT_EQ(again.near, skin.near);
      EXPECT_EQ(follow(again, moved), expected);
    });
}

std::vector<double> reals(const Column& column) {
  return std::get<std::vector<double>>(column.values);
}

TEST(SkinValues, AreTheParticlesOwnWhereTheseAreAlike) {
  const Points points = test::fcc_box(5, 5, 9, r);
  const Skin skin = make_skin(vertices_around(points, 12 * r), points, r);
  std::vector<double> tensor;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int c = 0; c < 6; ++c) tensor.push_back(c - 2.5);
  const Column found = at_vertices(skin, {"stress", 6, tensor});
  EXPECT_EQ(found.name, "stress");
  EXPECT_EQ(found.components, 6);
  ASSERT_EQ(reals(found).size(), 6 * skin.rest.size());
  for (std::size_t k = 0; k < reals(found).size(); ++k)
    EXPECT_NEAR(reals(found)[k], static_cast<double>(k % 6) - 2.5, 1e-14);
}

TEST(SkinValues, OfALinearFieldAreExactWhereParticlesLieAroundAPointAlike) {
  const Points points = test::fcc_box(9, 9, 9, r);
  Box box;
  for (const Vec3& point : points) box.extend(point);
  const auto middle = std::min_element(points.begin(), points.end(), [&](auto& a, auto& b) {
    return (a - box.center()).norm() < (b - box.center()).norm();
  });
  Points vertices = vertices_around(points, r);
  vertices.push_back(*middle);
  const Skin skin = make_skin(vertices, points, r);
  const Vec3 slope(3, -2, 7);
  std::vector<double> field;
  for (const Vec3& point : points) field.push_back(1 + slope.dot(point));
  const std::vector<double> found = reals(at_vertices(skin, column("field", field)));
  EXPECT_NEAR(found.back(), 1 + slope.dot(*middle), 1e-13);
  for (std::size_t i = 0; i < vertices.size(); ++i)  // no particle is farther away than that
    EXPECT_LE(std::abs(found[i] - 1 - slope.dot(vertices[i])), 6 * r * slope.norm());
}

TEST(SkinValues, AreOfTheParticlesThatHaveOneAndNoneWhereNoneHas) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const Points points = test::fcc_box(5, 5, 25, r);
  const Skin skin = make_skin({points.front(), points.back()}, points, r);
  std::vector<double> values(points.size(), none);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (i % 2 == 0 && points[i].z() < points.back().z() - 7 * r) values[i] = 4;
  const std::vector<double> found = reals(at_vertices(skin, column("strain_eq", values)));
  EXPECT_NEAR(found[0], 4, 1e-14);
  EXPECT_TRUE(std::isnan(found[1]));
}

TEST(SkinValues, ThatAreWholeNumbersAreThoseOfTheLargestWeight) {
  const Points points = test::fcc_box(5, 5, 9, r);
  const Points vertices = vertices_around(points, r);
  const Skin skin = make_skin(vertices, points, r);
  std::vector<std::int32_t> id;
  for (std::size_t i = 0; i < points.size(); ++i) id.push_back(static_cast<std::int32_t>(7 * i));
  const Column found = at_vertices(skin, column("id", id));
  const auto& ids = std::get<std::vector<std::int32_t>>(found.values);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    for (const Vec3& point : points)
      EXPECT_LE((points[static_cast<std::size_t>(ids[i] / 7)] - vertices[i]).norm(),
                (point - vertices[i]).norm() + 1e-12);
}

}  // namespace sinew::skin_test
