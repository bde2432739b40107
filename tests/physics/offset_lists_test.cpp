// SPDX-License-Identifier: GPL-3.0-or-later
// Lists of differences and the cell grids of blocks that find them, against all pairs.
#include <sinew/physics/lists/offset_lists.h>

#include <set>

#include <sinew/core/cell_grid.h>
#include <sinew/core/parallel.h>

#include "all_steppers.h"

namespace sinew {
namespace {

constexpr double r = 0.01;

PairForce pair_of_material() { return test::material_of(test::box_scene()).pair; }

/// Points in the kernel's layout.
template <class Real>
struct World {
  Units units;
  BlockState<Real> state;
  double range;  ///< in lengths of the kernel

  World(const Points& points, double meters) : state(points.size()) {
    Box box;
    for (const Vec3& point : points) box.extend(point);
    units = units_for<Real>(box, pair_of_material(), 1e-3);
    for (std::size_t k = 0; k < points.size(); ++k) state.set_position(k, points[k], units);
    range = meters / units.length;
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

/// Each list is its block's set, hence ascending, each once, and never 0.
void expect_lists(const OffsetLists& lists, const std::vector<std::set<std::int32_t>>& expected) {
  ASSERT_EQ(lists.first.size(), expected.size() + 1);
  ASSERT_EQ(lists.first.front(), 0u);
  ASSERT_EQ(lists.first.back(), lists.value.size());
  for (std::size_t block = 0; block < expected.size(); ++block) {
    const std::vector<std::int32_t> list(lists.value.begin() + lists.first[block],
                                         lists.value.begin() + lists.first[block + 1]);
    const std::vector<std::int32_t> all(expected[block].begin(), expected[block].end());
    ASSERT_EQ(list, all) << "block " << block;
  }
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

TYPED_TEST(OffsetListsOf, NameTheDifferencesOfAllPairsInRangeAndNoOthers) {
  for (const Points& body : bodies()) {
    World<TypeParam> world(body, 3.6 * r);
    const BlockCells cells(world.state, world.range);
    const auto expected = by_all_pairs(world, world.range);
    for (const auto set : test::instruction_sets())
      expect_lists(
          find_offsets(kernel::functions_of<TypeParam>(set), world.state, cells, world.range),
          expected);
  }
}

TYPED_TEST(OffsetListsOf, PrunedToAShorterRangeAreTheListsOfThatRange) {
  for (const Points& body : bodies()) {
    World<TypeParam> world(body, 3.6 * r);
    const BlockCells cells(world.state, world.range);
    const double shorter = world.range * 2.7 / 3.6;
    const auto expected = by_all_pairs(world, shorter);
    for (const auto set : test::instruction_sets()) {
      const auto kernel = kernel::functions_of<TypeParam>(set);
      const OffsetLists wide = find_offsets(kernel, world.state, cells, world.range);
      expect_lists(prune_offsets(kernel, world.state, wide, shorter), expected);
    }
  }
}

TYPED_TEST(OffsetListsOf, LargeBodiesAreRightAndTheSameForEveryThreadCount) {
  const Material material = test::material_of(test::box_scene());
  const Particles shaken = test::shaken(test::fcc_box(31, 31, 61, r), material, 0.3 * r, 0);
  World<TypeParam> world(positions_of(shaken), 3.6 * r);
  ASSERT_GT(world.state.blocks(), 1024u);  // more than one piece
  const auto kernel = kernel::functions_of<TypeParam>(kernel::best_instruction_set());
  std::vector<OffsetLists> wide, narrow;
  for (const int threads : {1, 2, 3, 8})
    with_threads(threads, [&] {
      const BlockCells cells(world.state, world.range);
      wide.push_back(find_offsets(kernel, world.state, cells, world.range));
      narrow.push_back(prune_offsets(kernel, world.state, wide.back(), 0.75 * world.range));
    });
  if (std::is_same_v<TypeParam, double>)
    expect_lists(wide[0],
                 by_neighbors(positions_of(shaken), 3.6 * r, BlockState<TypeParam>::block));
  for (const OffsetLists& other : wide) {
    EXPECT_EQ(other.first, wide[0].first);
    EXPECT_EQ(other.value, wide[0].value);
  }
  for (const OffsetLists& other : narrow) {
    EXPECT_EQ(other.first, narrow[0].first);
    EXPECT_EQ(other.value, narrow[0].value);
  }
}

TYPED_TEST(OffsetListsOf, BlocksOfALatticeInOrderAreShort) {
  World<TypeParam> world(test::fcc_box(21, 21, 41, r), 2.7 * r);
  const BlockCells cells(world.state, world.range);
  const auto kernel = kernel::functions_of<TypeParam>(kernel::best_instruction_set());
  EXPECT_LT(find_offsets(kernel, world.state, cells, world.range).mean(), 40);
}

TYPED_TEST(OffsetListsOf, WithOthersAddedAreTheUnion) {
  World<TypeParam> world(test::fcc_box(9, 9, 41, r), 2.7 * r);
  const BlockCells cells(world.state, world.range);
  const OffsetLists lists =
      find_offsets(kernel::functions_of<TypeParam>(kernel::best_instruction_set()), world.state,
                   cells, world.range);
  std::vector<std::set<std::int32_t>> expected(world.state.blocks());
  std::vector<BlockOffset> added;
  std::mt19937 random(4);
  for (int k = 0; k < 300; ++k)  // many twice, many that are there
    added.push_back({static_cast<std::uint32_t>(random() % expected.size()),
                     static_cast<std::int32_t>(random() % 60) - 80});
  for (std::size_t block = 0; block < expected.size(); ++block)
    expected[block].insert(lists.value.begin() + lists.first[block],
                           lists.value.begin() + lists.first[block + 1]);
  for (const BlockOffset& one : added) expected[one.block].insert(one.offset);
  expect_lists(with_added(lists, added), expected);
  for (const BlockOffset& one : added) EXPECT_TRUE(with_added(lists, added).has(one));
  EXPECT_EQ(with_added(lists, {}).value, lists.value);
}

template <class Real>
class OrderOf : public testing::Test {};
TYPED_TEST_SUITE(OrderOf, Reals);

TYPED_TEST(OrderOf, ColumnsNamesEveryParticleOnceForEveryThreadCount) {
  for (const Points& body : bodies()) {
    World<TypeParam> world(body, 3.6 * r);
    const double edge = 2 * r / world.units.length;
    const auto order = order_by_columns(world.state, edge);
    auto sorted = order;
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(sorted.size(), body.size());
    for (std::uint32_t k = 0; k < sorted.size(); ++k) ASSERT_EQ(sorted[k], k);
    with_threads(3, [&] { ASSERT_EQ(order_by_columns(world.state, edge), order); });
  }
}

TYPED_TEST(OrderOf, ColumnsShortensTheListsOfAShuffledBody) {
  Points points = test::fcc_box(15, 15, 41, r);
  std::shuffle(points.begin(), points.end(), std::mt19937(3));
  World<TypeParam> world(points, 3.6 * r);
  const auto kernel = kernel::functions_of<TypeParam>(kernel::best_instruction_set());
  const auto mean = [&](BlockState<TypeParam>& state) {
    return find_offsets(kernel, state, BlockCells(state, world.range), world.range).mean();
  };
  BlockState<TypeParam> sorted(points.size());
  const auto order = order_by_columns(world.state, 2.4 * r / world.units.length);
  reorder(world.state, order, sorted);
  for (std::size_t k = 0; k < points.size(); ++k)
    ASSERT_EQ(sorted.position(k, world.units), world.state.position(order[k], world.units));
  EXPECT_LT(mean(sorted), 0.6 * mean(world.state));
}

template <class Real>
class BlockCellsOf : public testing::Test {};
TYPED_TEST_SUITE(BlockCellsOf, Reals);

TYPED_TEST(BlockCellsOf, HoldEachParticleInItsBox) {
  for (const Points& body : bodies()) {
    World<TypeParam> world(body, 3.6 * r);
    const BlockCells cells(world.state, world.range);
    ASSERT_GE(cells.edge(), world.range);
    ASSERT_LE(cells.cells(), 4 * body.size() + 4096);
    const auto arrays = world.state.arrays();
    for (std::size_t k = 0; k < body.size(); ++k) {
      const auto cell = static_cast<std::int64_t>(cells.cell_of_particle()[k]);
      const std::int64_t nx = cells.counts()[0], ny = cells.counts()[1];
      const std::int64_t index[3] = {cell % nx, cell / nx % ny, cell / (nx * ny)};
      for (int axis = 0; axis < 3; ++axis) {
        const double inside = static_cast<double>(arrays.x[axis][k]) - cells.low()[axis];
        ASSERT_GE(inside, cells.edge() * static_cast<double>(index[axis]) * (1 - 1e-12));
        ASSERT_LE(inside, cells.edge() * static_cast<double>(index[axis] + 1) * (1 + 1e-12));
      }
    }
  }
}

TYPED_TEST(BlockCellsOf, FindAllBlocksInReachOnceInAscendingOrder) {
  for (const Points& body : bodies()) {
    World<TypeParam> world(body, 3.6 * r);
    constexpr int size = BlockState<TypeParam>::block;
    const BlockCells cells(world.state, world.range);
    BlockCells::Finder finder(cells);
    const auto lists = by_all_pairs(world, world.range);
    for (std::size_t block = 0; block < world.state.blocks(); ++block) {
      std::vector<std::uint32_t> found;
      finder.for_each_around(block, [&](std::uint32_t other) { found.push_back(other); });
      ASSERT_TRUE(std::is_sorted(found.begin(), found.end(), std::less_equal<>()));
      ASSERT_TRUE(std::binary_search(found.begin(), found.end(), block));
      ASSERT_LT(found.back(), world.state.blocks());
      for (const std::int32_t difference : lists[block])
        for (std::size_t i = block * size; i < std::min((block + 1) * size, body.size()); ++i) {
          const auto j = static_cast<std::int64_t>(i) + difference;
          if (j < 0 || j >= static_cast<std::int64_t>(body.size())) continue;
          const double squared = world.squared_distance(i, static_cast<std::size_t>(j));
          if (squared >= world.range * world.range) continue;
          ASSERT_TRUE(std::binary_search(found.begin(), found.end(), j / size));
        }
    }
  }
}

TYPED_TEST(BlockCellsOf, FindAllBlocksWithinTwoEdgesOfAnyPoint) {
  std::mt19937 random(9);
  for (const Points& body : bodies()) {
    World<TypeParam> world(body, 3.6 * r);
    const BlockCells cells(world.state, world.range);
    const auto arrays = world.state.arrays();
    for (int trial = 0; trial < 40; ++trial) {
      const std::size_t at = random() % body.size();
      const auto place = [&](std::size_t k) {
        return Vec3(static_cast<double>(arrays.x[0][k]), static_cast<double>(arrays.x[1][k]),
                    static_cast<double>(arrays.x[2][k]));
      };
      const Vec3 point = place(at) + 4 * cells.edge() * test::random_vector(random);
      std::set<std::size_t> found;
      cells.for_each_block_near(point, [&](std::uint32_t block) { found.insert(block); });
      for (std::size_t k = 0; k < body.size(); ++k)
        ASSERT_TRUE((place(k) - point).norm() >= 2 * cells.edge() ||
                    found.count(k / BlockState<TypeParam>::block) > 0);
    }
  }
}

TYPED_TEST(BlockCellsOf, FindFewBlocksWhereSpaceIsInOrder) {
  World<TypeParam> world(test::fcc_box(21, 21, 41, r), 3.6 * r);
  const BlockCells cells(world.state, world.range);
  BlockCells::Finder finder(cells);
  std::size_t found = 0;
  for (std::size_t block = 0; block < world.state.blocks(); ++block)
    finder.for_each_around(block, [&](std::uint32_t) { ++found; });
  EXPECT_LT(found, 250 * world.state.blocks());
}

TYPED_TEST(BlockCellsOf, OfNobodyAreEmpty) {
  World<TypeParam> world({}, 3.6 * r);
  const BlockCells cells(world.state, world.range);
  EXPECT_EQ(world.state.blocks(), 0u);
  EXPECT_TRUE(cells.cell_of_particle().empty());
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

}  // namespace
}  // namespace sinew
