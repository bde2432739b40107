// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/particles.h>

#include <gtest/gtest.h>
#include <cmath>
#include <numeric>
#include <random>

#include <sinew/core/cell_grid.h>
#include <sinew/core/hash.h>
#include <sinew/core/local_origin.h>
#include <sinew/core/parallel.h>

#include "support/world.h"

namespace sinew::particles_test {

TEST(Hash, IsFnv1aOf64Bits) {  // published vectors of the algorithm
  Hash hash;
  EXPECT_EQ(hash_text(hash.value()), "cbf29ce484222325");
  hash.add("foobar");
  EXPECT_EQ(hash_text(hash.value()), "85944171f73967e8");
  EXPECT_EQ(hash_text(0xabc), "0000000000000abc");
}

TEST(LocalOrigin, IsNearABodyFarAwayAndZeroNearTheOrigin) {
  const auto box_at = [](const Vec3& low) { return Box(low, low + Vec3(0.3, 0.4, 1.2)); };
  EXPECT_EQ(local_origin({}), Vec3(0, 0, 0));
  EXPECT_EQ(local_origin(Box(Vec3(1e9, 0, 0), Vec3(1e9, 0, 0))), Vec3(0, 0, 0));
  EXPECT_EQ(local_origin(box_at({100, -50, 10})), Vec3(0, 0, 0));
  for (const double far : {1e3, 403000.123, 1e7}) {
    const Vec3 low(far, -3 * far, 0.1), origin = local_origin(box_at(low));
    EXPECT_LT((origin - low).norm(), 3);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(origin[axis], std::round(origin[axis] / 2) * 2);
      EXPECT_EQ(static_cast<float>(origin[axis]), origin[axis]);
      EXPECT_EQ((low[axis] - origin[axis]) + origin[axis], low[axis]);
    }
  }
}

Particles three() {
  Particles particles = particles_at({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}, 0.5, 2);
  particles.set_velocity(1, {0.1, 0.2, 0.3});
  return particles;
}

TEST(Particles, AreAtRestInTheGivenOrder) {
  const Particles particles = particles_at({{1, 2, 3}, {4, 5, 6}}, 0.5, 2);
  EXPECT_EQ(particles.radius, 0.5);
  EXPECT_EQ(particles.mass, 2);
  EXPECT_EQ(particles.position(1), Vec3(4, 5, 6));
  EXPECT_EQ(particles.velocity(1), Vec3::Zero());
  EXPECT_EQ(particles.id, (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(positions_of(particles), (Points{{1, 2, 3}, {4, 5, 6}}));
}

TEST(StateHash, DoesNotDependOnTheOrderOfTheParticles) {
  const Particles particles = three();
  const Particles other = test::reordered(particles, {2, 0, 1});
  ASSERT_NE(other.x, particles.x);
  EXPECT_EQ(state_hash(other), state_hash(particles));
}

TEST(StateHash, SeesTheLastBitOfEveryNumber) {
  const Particles particles = three();
  for (auto axis :
       {&Particles::x, &Particles::y, &Particles::z, &Particles::u, &Particles::v, &Particles::w})
    for (std::size_t i = 0; i < particles.size(); ++i) {
      Particles other = particles;
      (other.*axis)[i] = std::nextafter((other.*axis)[i], 100.0);
      EXPECT_NE(state_hash(other), state_hash(particles));
    }
}

TEST(StateHash, OfManyParticlesDependsNeitherOnOrderNorOnThreads) {
  std::mt19937 random(7);
  Points positions(50'000);
  for (Vec3& position : positions) position = test::random_vector(random);
  const Particles particles = particles_at(positions, 0.5, 2);
  std::vector<std::size_t> order(particles.size());
  std::iota(order.rbegin(), order.rend(), 0);
  Particles other = test::reordered(particles, order);
  for (const int threads : {1, 2, 5})
    with_threads(threads, [&] { EXPECT_EQ(state_hash(other), state_hash(particles)); });
  for (const std::size_t i : {std::size_t{0}, std::size_t{20'000}, particles.size() - 1}) {
    Particles changed = particles;
    changed.w[i] = std::nextafter(changed.w[i], 1.0);
    EXPECT_NE(state_hash(changed), state_hash(particles));
  }
}

TEST(ClosestPacking, HasTwelveNeighborsAndThePaperCounts) {
  const double r = 0.01;
  for (const Points& points : {test::fcc_box(11, 11, 49, r), test::hcp_ball(6, r)}) {
    const auto first = neighbors_within(points, rest_neighbor_range(r));
    const auto second = neighbors_within(points, 1.01 * second_distance(r));
    std::size_t most = 0, max_second = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      most = std::max(most, first.of(i).size());
      max_second = std::max(max_second, second.of(i).size());
    }
    EXPECT_EQ(most, 12u);
    EXPECT_EQ(max_second, 18u);
  }
  EXPECT_EQ(test::fcc_box(11, 11, 49, r).size(), 2965u);
}

}  // namespace sinew::particles_test
