// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <sinew/core/parallel.h>
#include <sinew/rig/skinning.h>

#include "support/world.h"

namespace sinew::bone_weights_test {

/// Vertices on a grid of a square; weights pass from bone 0 to bone 1 along x.
struct Sheet {
  Points vertices;
  BoneWeights weights;

  Sheet() {
    weights.first.push_back(0);
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; j <= 20; ++j) {
        vertices.emplace_back(0.05 * i, 0.05 * j, 0);
        const double weight = 0.05 * i;
        if (weight >= 0.5 && weight > 0) weights.weights.push_back({1, weight});
        if (weight < 1) weights.weights.push_back({0, 1 - weight});
        if (weight < 0.5 && weight > 0) weights.weights.push_back({1, weight});
        weights.first.push_back(static_cast<std::uint32_t>(weights.weights.size()));
      }
  }
};

double weight_of(const BoneWeights& weights, std::size_t i, int bone) {
  for (const BoneWeight& one : weights.of(i))
    if (one.bone == bone) return one.weight;
  return 0;
}

TEST(CarriedWeights, AreThoseOfAVertexOnIt) {
  const Sheet sheet;
  const BoneWeights carried = carried_weights(sheet.vertices, sheet.weights, sheet.vertices);
  for (std::size_t i = 0; i < sheet.vertices.size(); ++i)
    EXPECT_NEAR(weight_of(carried, i, 1), sheet.vertices[i].x(), 1e-6);
}

TEST(CarriedWeights, FollowTheVerticesNear) {
  const Sheet sheet;
  const Points points = {{0.225, 0.5, 0.01}, {0.5, 0.525, 0.3}, {0.9, 0.1, -0.02}, {5, 0.5, 0}};
  const BoneWeights carried = carried_weights(sheet.vertices, sheet.weights, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(weight_of(carried, i, 1), std::min(points[i].x(), 1.0), 0.03);
    EXPECT_NEAR(weight_of(carried, i, 0) + weight_of(carried, i, 1), 1, 1e-12);
  }
}

TEST(CarriedWeights, KeepTheFourHeaviestBonesAndSkipVerticesWithoutAny) {
  Points vertices;
  BoneWeights weights;
  weights.first.push_back(0);
  for (int i = 0; i < 7; ++i) {
    vertices.emplace_back(i, 0, 0);
    if (i > 0) weights.weights.push_back({i, 1});
    weights.first.push_back(static_cast<std::uint32_t>(weights.weights.size()));
  }
  const BoneWeights carried = carried_weights(vertices, weights, {{-1, 0, 0}});
  ASSERT_EQ(carried.of(0).size(), 4u);
  double sum = 0;
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(carried.of(0)[k].bone, k + 1);
    sum += carried.of(0)[k].weight;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(CarriedWeights, WithoutAnyAreNone) {
  const BoneWeights none{{0, 0}, {}};
  EXPECT_TRUE(carried_weights({{0, 0, 0}}, none, {{1, 1, 1}}).of(0).empty());
}

TEST(CarriedWeights, HaveTheSameBitsForEveryThreadCount) {
  const Sheet sheet;
  const Points points = test::fcc_box(9, 9, 9, 0.05);
  const BoneWeights expected = carried_weights(sheet.vertices, sheet.weights, points);
  for (const int threads : {1, 3, 8})
    with_threads(threads, [&] {
      const BoneWeights found = carried_weights(sheet.vertices, sheet.weights, points);
      ASSERT_EQ(found.first, expected.first);
      for (std::size_t k = 0; k < found.weights.size(); ++k)
        ASSERT_EQ(found.weights[k].weight, expected.weights[k].weight);
    });
}

}  // namespace sinew::bone_weights_test
