// SPDX-License-Identifier: GPL-3.0-or-later
// Lists of differences against all pairs, and the layout of the state.
#include <sinew/lists/offset_lists.h>

#include <numeric>
#include <set>

#include <sinew/core/cell_grid.h>

#include "support/all_steppers.h"

namespace sinew::offset_lists_test {

constexpr double r = 0.01;

PairForce pair_of_material() { return test::material_of(test::box_scene()).pair; }

/// Points in the kernel's layout.
template <class Real>
struct World {
  Units units;
  BlockState<Real> state;
  double range;   ///< in lengths of the kernel
  double beyond;  ///< the same: no pair farther than this is listed

  World(const Points& points, double meters) : state(points.size()) {
    Box box;
    for (const Vec3& point : points) box.extend(point);
    units = units_for<Real>(box, pair_of_material(), 1e-3);
    for (std::size_t k = 0; k < points.size(); ++k) state.set_position(k, points[k], units);
    range = meters / units.length;
    const double across = 2 * box.diagonal().norm() / units.length + range;
    beyond = std::sqrt((1 + 1e-5) * range * range + 2e-6 * across * across);
  }

  /// The squared distance as the kernel rounds it.
  Real squared_distance(std::size_t i, std::size_t j) {
    const auto arrays = state.arrays();
    Real d[3];
    for (int axis = 0; axis < 3; ++axis)
      d[axis] = static_cast<Real>(arrays.x[axis][i] - arrays.x[axis][j]);
    return d[0] * d[0] + (d[1] * d[1] + d[2] * d[2]);
  }
};

/// For each block the differences j - i of its pairs nearer than `range`, by brute force.
template <class Real>
std::vector<std::set<std::int32_t>> by_all_pairs(World<Real>& world, double range) {
  const auto range2 = static_cast<Real>(range * range);
  std::vector<std::set<std::int32_t>> differences(world.state.blocks());
  const std::size_t n = world.state.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      if (i != j && world.squared_distance(i, j) < range2)
        differences[i / BlockState<Real>::block].insert(static_cast<std::int32_t>(j) -
                                                        static_cast<std::int32_t>(i));
  return differences;
}

/// The same for many points, in meters.
std::vector<std::set<std::int32_t>> by_neighbors(const Points& points, double range,
                                                 std::size_t block) {
  const NeighborLists near = neighbors_within(points, range);
  std::vector<std::set<std::int32_t>> differences((points.size() + block - 1) / block);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (const std::uint32_t j : near.of(i))
      differences[i / block].insert(static_cast<std::int32_t>(j) - static_cast<std::int32_t>(i));
  return differences;
}

/// The lists of all pieces.
template <class Real>
std::vector<OffsetLists> lists_of(const kernel::Functions<Real>& kernel, World<Real>& world) {
  const std::size_t pieces =
      (world.state.blocks() + kernel::blocks_per_piece - 1) / kernel::blocks_per_piece;
  std::vector<std::uint32_t> all(pieces);
  std::iota(all.begin(), all.end(), 0U);
  BlockBoxes boxes;
  boxes.resize(pieces);
  for (const std::uint32_t piece : all) find_boxes(kernel, world.state, piece, boxes);
  std::vector<OffsetLists> lists;
  for (const std::uint32_t piece : all)
    lists.push_back(find_offsets(kernel, world.state, piece, all, boxes, world.range));
  return lists;
}

template <class Real>
std::vector<OffsetLists> pruned(const kernel::Functions<Real>& kernel, World<Real>& world,
                                const std::vector<OffsetLists>& outer, double range) {
  std::vector<OffsetLists> lists;
  for (std::size_t piece = 0; piece < outer.size(); ++piece)
    lists.push_back(prune_offsets(kernel, world.state, piece, outer[piece], range));
  return lists;
}

double mean_of(const std::vector<OffsetLists>& lists) {
  std::size_t values = 0, blocks = 0;
  for (const OffsetLists& piece : lists)
    values += piece.value.size(), blocks += piece.first.size() - 1;
  return static_cast<double>(values) / static_cast<double>(blocks);
}

/// Each list ascends, each difference once, has all of its block's `least` and none but `most`.
void expect_lists(const std::vector<OffsetLists>& lists,
                  const std::vector<std::set<std::int32_t>>& least,
                  const std::vector<std::set<std::int32_t>>& most) {
  std::size_t block = 0;
  for (const OffsetLists& piece : lists) {
    ASSERT_EQ(piece.first.front(), 0u);
    ASSERT_EQ(piece.first.back(), piece.value.size());
    for (std::size_t k = 0; k + 1 < piece.first.size(); ++k, ++block) {
      const std::vector<std::int32_t> list(piece.value.begin() + piece.first[k],
                                           piece.value.begin() + piece.first[k + 1]);
      const std::set<std::int32_t> listed(list.begin(), list.end());
      ASSERT_EQ(list, std::vector<std::int32_t>(listed.begin(), listed.end())) << block;
      ASSERT_TRUE(
          std::includes(listed.begin(), listed.end(), least[block].begin(), least[block].end()))
          << "block " << block;
      ASSERT_TRUE(
          std::includes(most[block].begin(), most[block].end(), listed.begin(), listed.end()))
          << "block " << block;
    }
  }
  ASSERT_EQ(block, least.size());
}

/// Each list is its block's set.
void expect_lists(const std::vector<OffsetLists>& lists,
                  const std::vector<std::set<std::int32_t>>& expected) {
  expect_lists(lists, expected, expected);
}

Points disordered(std::size_t count, double edge, unsigned seed) {
  std::mt19937 random(seed);
  Points points;
  for (std::size_t k = 0; k < count; ++k) points.push_back(edge * test::random_vector(random));
  return points;
}

/// Whole blocks of coincident particles, each place barely within `range` of the next, where floats
/// resolve 0.2 mm at best.
Points far_beads(double range) {
  Points points;
  for (int bead = 0; bead < 20; ++bead)
    points.insert(points.end(), 16, Vec3(3000 + bead * (1 - 1e-6) * range, 2000, -4000));
  return points;
}

/// Bodies in all states that lists encounter.
std::vector<Points> bodies() {
  const Points lattice = test::fcc_box(9, 9, 13, r);
  Points shuffled = lattice;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
  Points escaped = lattice;
  escaped[100] += Vec3(50, 0, 0);
  escaped.back() += Vec3(0, -700, 30);
  Points far = lattice;
  for (Vec3& point : far) point += Vec3(3e4, -2e4, 1e4);
  return {lattice,
          shuffled,
          escaped,
          far,
          test::affine(lattice, 0.4 * Mat3::Identity()),
          test::affine(lattice, Vec3(1, 1, 0).asDiagonal()),
          disordered(700, 0.25, 5),
          disordered(333, 0.03, 6),
          Points(40, Vec3(1, 2, 3)),
          far_beads(3.6 * r),
          {Vec3(0, 0, 0)},
          {Vec3(0, 0, 0), Vec3(0, 0, 2 * r)},
          Points(lattice.begin(), lattice.begin() + 17),
          Points(lattice.begin(), lattice.begin() + 33)};
}

template <class Real>
class OffsetListsOf : public testing::Test {};
using Reals = testing::Types<double, float>;
TYPED_TEST_SUITE(OffsetListsOf, Reals);

TYPED_TEST(OffsetListsOf, NameTheDifferencesOfAllPairsInRangeAndFewOthers) {
  for (const Points& body : bodies()) {
    World<TypeParam> world(body, 3.6 * r);
    const auto least = by_all_pairs(world, world.range), most = by_all_pairs(world, world.beyond);
    for (const auto set : test::instruction_sets())
      expect_lists(lists_of(kernel::functions_of<TypeParam>(set), world), least, most);
  }
}

TYPED_TEST(OffsetListsOf, AreTheSameOnAllInstructionSets) {
  for (const Points& body : bodies()) {
    World<TypeParam> world(body, 3.6 * r);
    const auto expected =
        lists_of(kernel::functions_of<TypeParam>(kernel::InstructionSet::plain), world);
    for (const auto set : test::instruction_sets()) {
      const auto lists = lists_of(kernel::functions_of<TypeParam>(set), world);
      for (std::size_t piece = 0; piece < lists.size(); ++piece) {
        EXPECT_EQ(lists[piece].first, expected[piece].first);
        EXPECT_EQ(lists[piece].value, expected[piece].value);
      }
    }
  }
}

TYPED_TEST(OffsetListsOf, PrunedToAShorterRangeAreTheListsOfThatRange) {
  for (const Points& body : bodies()) {
    World<TypeParam> world(body, 3.6 * r);
    const double shorter = world.range * 2.7 / 3.6;
    const auto expected = by_all_pairs(world, shorter);
    for (const auto set : test::instruction_sets()) {
      const auto kernel = kernel::functions_of<TypeParam>(set);
      expect_lists(pruned(kernel, world, lists_of(kernel, world), shorter), expected);
    }
  }
}

TYPED_TEST(OffsetListsOf, LargeBodiesAreRight) {
  const Material material = test::material_of(test::box_scene());
  const Particles shaken = test::shaken(test::fcc_box(31, 31, 61, r), material, 0.3 * r, 0);
  World<TypeParam> world(positions_of(shaken), 3.6 * r);
  const auto kernel = kernel::functions_of<TypeParam>(kernel::best_instruction_set());
  const auto lists = lists_of(kernel, world);
  ASSERT_GT(lists.size(), 30u);
  constexpr int size = BlockState<TypeParam>::block;
  if (std::is_same_v<TypeParam, double>) {
    const Points at = positions_of(shaken);
    expect_lists(lists, by_neighbors(at, 3.6 * r, size), by_neighbors(at, 3.605 * r, size));
  }
}

TYPED_TEST(OffsetListsOf, BlocksOfALatticeInOrderAreShort) {
  World<TypeParam> world(test::fcc_box(21, 21, 41, r), 2.7 * r);
  const auto kernel = kernel::functions_of<TypeParam>(kernel::best_instruction_set());
  EXPECT_LT(mean_of(lists_of(kernel, world)), 40);
}

template <class Real>
class BlockStateOf : public testing::Test {};
TYPED_TEST_SUITE(BlockStateOf, Reals);

TYPED_TEST(BlockStateOf, GivesBackPositionsAndVelocities) {
  for (const Points& body : bodies()) {
    World<TypeParam> world(body, 3.6 * r);
    const double position = sizeof(TypeParam) == 8 ? 0 : 0.87 * world.units.length + 1e-11;
    const double velocity = sizeof(TypeParam) == 8 ? 0 : 1e-7;
    for (std::size_t k = 0; k < body.size(); ++k) {
      const Vec3 v(1, -2, 0.1 * static_cast<double>(k % 10));
      world.state.set_velocity(k, v, world.units);
      ASSERT_LE((world.state.position(k, world.units) - body[k]).norm(), position);
      ASSERT_LE((world.state.velocity(k, world.units) - v).norm(), velocity * v.norm());
    }
  }
}

TYPED_TEST(BlockStateOf, PadsAreFarFromAllAndFromEachOther) {
  for (const Points& body : bodies()) {
    World<TypeParam> world(body, 3.6 * r);
    constexpr std::ptrdiff_t size = BlockState<TypeParam>::block;
    const auto arrays = world.state.arrays();
    const auto n = static_cast<std::ptrdiff_t>(body.size());
    const auto end = (static_cast<std::ptrdiff_t>(world.state.blocks()) + 1) * size;
    const double reach = std::pow(4 * pair_of_material().b / world.units.length, 2);
    const auto apart = [&](std::ptrdiff_t i, std::ptrdiff_t j) {
      double squared = 0;
      for (int axis = 0; axis < 3; ++axis) {
        using Coord = typename BlockState<TypeParam>::Coord;
        double d = static_cast<double>(arrays.x[axis][i]) - static_cast<double>(arrays.x[axis][j]);
        if constexpr (std::is_integral_v<Coord>) d = std::remainder(d, 4294967296.0);
        squared += d * d;
      }
      return squared > reach;
    };
    for (std::ptrdiff_t pad = -size; pad < end; ++pad) {
      if (pad >= 0 && pad < n) continue;
      for (std::ptrdiff_t other = -size; other < end; ++other)
        ASSERT_TRUE(pad == other || apart(pad, other)) << pad << " " << other;
    }
  }
}

}  // namespace sinew::offset_lists_test
