// SPDX-License-Identifier: GPL-3.0-or-later
// Orders hold every particle once, and keep together what is together.
#include <sinew/lists/particle_order.h>

#include <numeric>

#include <sinew/core/parallel.h>

#include "support/all_steppers.h"

namespace sinew::particle_order_test {

constexpr double r = 0.01;

void expect_each_once(std::vector<std::uint32_t> order, std::size_t count) {
  std::sort(order.begin(), order.end());
  ASSERT_EQ(order.size(), count);
  for (std::uint32_t k = 0; k < count; ++k) ASSERT_EQ(order[k], k);
}

std::vector<std::int32_t> all(std::size_t count) {
  std::vector<std::int32_t> id(count);
  std::iota(id.begin(), id.end(), 0);
  return id;
}

Points shuffled(Points points) {
  std::shuffle(points.begin(), points.end(), std::mt19937(3));
  return points;
}

template <class Real>
BlockState<Real> state_of(const Points& points, Units& units) {
  Box box;
  for (const Vec3& point : points) box.extend(point);
  units = units_for<Real>(box, test::material_of(test::box_scene()).pair, 1e-3);
  BlockState<Real> state(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) state.set_position(k, points[k], units);
  return state;
}

/// How far consecutive particles are from each other, on average, m.
double mean_step(const Points& points, const std::vector<std::uint32_t>& order) {
  double sum = 0;
  for (std::size_t k = 1; k < order.size(); ++k)
    sum += (points[order[k]] - points[order[k - 1]]).norm();
  return sum / static_cast<double>(order.size() - 1);
}

template <class Real>
class OrderOf : public testing::Test {};
using Reals = testing::Types<double, float>;
TYPED_TEST_SUITE(OrderOf, Reals);

TYPED_TEST(OrderOf, ColumnsIsShortOnAnyThreads) {
  for (const Points& points :
       {shuffled(test::fcc_box(15, 15, 41, r)), test::hcp_ball(9, r), Points(40, Vec3(1, 2, 3)),
        Points{Vec3(0, 0, 0)}, Points{Vec3(0, 0, 0), Vec3(700, 0, 0)}}) {
    Units units;
    auto state = state_of<TypeParam>(points, units);
    const double edge = 2.4 * r / units.length;
    const auto order = order_by_columns(state, edge);
    expect_each_once(order, points.size());
    with_threads(3, [&] { EXPECT_EQ(order_by_columns(state, edge), order); });
    BlockState<TypeParam> sorted(points.size());
    reorder(state, order, sorted);
    for (std::size_t k = 0; k < points.size(); ++k)
      ASSERT_EQ(sorted.position(k, units), state.position(order[k], units));
    if (points.size() > 1000) {
      EXPECT_LT(mean_step(points, order), 4 * r);
    }
  }
}

TEST(OrderAtRest, GoesBoneByBoneInPlanesAcrossThem) {
  Settings settings = test::box_scene(49);
  const Points rest = shuffled(test::fcc_box(9, 9, 49, r));
  const Body body = test::make_body(settings, rest);
  const auto order = order_at_rest(body, all(rest.size()));
  expect_each_once(order, rest.size());
  for (std::size_t k = 1; k < order.size(); ++k) {
    const int before = body.binding.bone(order[k - 1]), now = body.binding.bone(order[k]);
    ASSERT_LE(before, now);
    if (before == now) {
      ASSERT_LE(rest[order[k - 1]].z(), rest[order[k]].z() + 1e-9);
    }
  }
}

TEST(OrderAtRest, OfABoneAcrossTheRowsTurnsThePlanes) {
  Settings settings = test::box_scene(49);
  settings.bones = {{"along x", "", Vec3(-0.1, 0, 0.1), Vec3(0.1, 0, 0.1)}};
  const Points rest = test::fcc_box(25, 7, 9, r);
  const auto order = order_at_rest(test::make_body(settings, rest), all(rest.size()));
  expect_each_once(order, rest.size());
  for (std::size_t k = 1; k < order.size(); ++k)
    ASSERT_LE(rest[order[k - 1]].x(), rest[order[k]].x() + 1e-9);
}

TEST(OrderAtRest, LeavesWhatIsOnNoLatticeAsItIs) {
  Settings settings = test::box_scene(25);
  settings.bones.resize(1);
  const Points rest = test::hcp_ball(6, r);
  std::vector<std::uint32_t> given(rest.size());
  std::iota(given.begin(), given.end(), 0U);
  EXPECT_EQ(order_at_rest(test::make_body(settings, rest), all(rest.size())), given);
}

TEST(OrderAtRest, OfSomeParticlesIsThatOfAllWithoutTheOthers) {
  const Points rest = shuffled(test::fcc_box(9, 9, 25, r));
  const Body body = test::make_body(test::box_scene(25), rest);
  std::vector<std::int32_t> some = all(rest.size());
  std::shuffle(some.begin(), some.end(), std::mt19937(5));
  some.resize(rest.size() / 3);
  const auto order = order_at_rest(body, some);
  expect_each_once(order, some.size());
  std::vector<std::int32_t> expected, found;
  for (const std::uint32_t i : order_at_rest(body, all(rest.size())))
    if (std::find(some.begin(), some.end(), static_cast<std::int32_t>(i)) != some.end())
      expected.push_back(static_cast<std::int32_t>(i));
  for (const std::uint32_t place : order) found.push_back(some[place]);
  EXPECT_EQ(found, expected);
}

}  // namespace sinew::particle_order_test
