// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/lists/offset_lists.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sinew {

namespace {

using kernel::blocks_per_piece;

template <class Real>
kernel::PruneInput<Real> prune_input(BlockState<Real>& state, double range) {
  return {state.arrays(), static_cast<Real>(range * range)};
}

/// The blocks of a piece: [first, last).
struct BlocksOf {
  std::size_t first, last;
  BlocksOf(std::size_t piece, std::size_t blocks)
      : first(piece * blocks_per_piece), last(std::min(first + blocks_per_piece, blocks)) {}
};

/// Along the axes of bounds.
struct AxisBounds {
  double low[kernel::bound_axes], high[kernel::bound_axes];

  AxisBounds() {
    std::fill_n(low, kernel::bound_axes, std::numeric_limits<double>::infinity());
    std::fill_n(high, kernel::bound_axes, -std::numeric_limits<double>::infinity());
  }

  void extend(double x, double y, double z) {
    const double along[kernel::bound_axes] = {x, y, z, x + y, x - y, y + z, y - z, z + x, z - x};
    for (int axis = 0; axis < kernel::bound_axes; ++axis) {
      low[axis] = std::min(low[axis], along[axis]);
      high[axis] = std::max(high[axis], along[axis]);
    }
  }

  void extend(const AxisBounds& other) {
    for (int axis = 0; axis < kernel::bound_axes; ++axis) {
      low[axis] = std::min(low[axis], other.low[axis]);
      high[axis] = std::max(high[axis], other.high[axis]);
    }
  }

  /// In floats, rounded outwards; diagonals in lengths.
  void put(std::size_t block, kernel::BlockBounds& bounds) const {
    constexpr float rounding = 2e-7F;
    for (int axis = 0; axis < kernel::bound_axes; ++axis) {
      const double scale = axis < 3 ? 1 : std::numbers::sqrt2 / 2;
      const auto least = static_cast<float>(scale * low[axis]);
      const auto most = static_cast<float>(scale * high[axis]);
      bounds.low[axis][block] = least - rounding * std::abs(least);
      bounds.high[axis][block] = most + rounding * std::abs(most);
    }
  }
};

/// Of blocks that there are not.
void clear(kernel::BlockBounds& bounds) {
  constexpr float never = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < kernel::bound_axes; ++axis) {
    std::fill_n(bounds.low[axis], blocks_per_piece, never);
    std::fill_n(bounds.high[axis], blocks_per_piece, -never);
  }
}

/// Around some pieces, as if each were a block.
std::vector<kernel::BlockBounds> bounds_of(std::span<const std::uint32_t> pieces,
                                           const BlockBoxes& boxes) {
  std::vector<kernel::BlockBounds> bounds((pieces.size() + blocks_per_piece - 1) /
                                          blocks_per_piece);
  if (!bounds.empty()) clear(bounds.back());
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    const kernel::BlockBounds& from = boxes.of_pieces[pieces[n] / blocks_per_piece];
    kernel::BlockBounds& to = bounds[n / blocks_per_piece];
    for (int axis = 0; axis < kernel::bound_axes; ++axis) {
      to.low[axis][n % blocks_per_piece] = from.low[axis][pieces[n] % blocks_per_piece];
      to.high[axis][n % blocks_per_piece] = from.high[axis][pieces[n] % blocks_per_piece];
    }
  }
  return bounds;
}

}  // namespace

void BlockBoxes::resize(std::size_t pieces) {
  of_blocks.resize(pieces);
  of_pieces.resize((pieces + blocks_per_piece - 1) / blocks_per_piece);
}

template <class Real>
void find_boxes(BlockState<Real>& state, std::size_t piece, BlockBoxes& boxes) {
  constexpr std::size_t size = BlockState<Real>::block;
  const auto arrays = state.arrays();
  const BlocksOf blocks(piece, state.blocks());
  kernel::BlockBounds& bounds = boxes.of_blocks[piece];
  clear(bounds);
  AxisBounds all;
  for (std::size_t block = blocks.first; block < blocks.last; ++block) {
    AxisBounds around;
    for (std::size_t k = block * size; k < std::min((block + 1) * size, state.size()); ++k)
      around.extend(static_cast<double>(arrays.x[0][k]), static_cast<double>(arrays.x[1][k]),
                    static_cast<double>(arrays.x[2][k]));
    around.put(block - blocks.first, bounds);
    all.extend(around);
  }
  all.put(piece % blocks_per_piece, boxes.of_pieces[piece / blocks_per_piece]);
}

template <class Real>
OffsetLists find_offsets(const kernel::Functions<Real>& kernel, BlockState<Real>& state,
                         std::size_t piece, std::span<const std::uint32_t> near,
                         const BlockBoxes& boxes, double range) {
  constexpr std::size_t most_of_a_block = 2 * BlockState<Real>::block;
  const auto input = prune_input(state, range);
  const auto reach = static_cast<float>(range * (1 + 1e-6));
  OffsetLists lists;
  lists.first.push_back(0);
  std::vector<std::uint32_t> others(near.size() * blocks_per_piece);
  const std::vector<kernel::BlockBounds> around = bounds_of(near, boxes);
  const kernel::SomePieces pieces{near.data(), near.size(), around.data()};
  std::vector<std::int32_t> found;
  const BlocksOf blocks(piece, state.blocks());
  for (std::size_t block = blocks.first; block < blocks.last; ++block) {
    const std::size_t blocks_near =
        kernel.near(boxes.of_blocks.data(), block, pieces, reach, others.data());
    found.resize(std::max(found.size(), most_of_a_block * blocks_near));
    const std::size_t count = kernel.list(input, block, others.data(), blocks_near, found.data());
    lists.value.insert(lists.value.end(), found.data(), found.data() + count);
    lists.first.push_back(static_cast<std::uint32_t>(lists.value.size()));
  }
  return lists;
}

template <class Real>
void remove_bonded(const BondLists<Real>& bonds, std::size_t piece, OffsetLists& lists) {
  constexpr std::uint32_t all = (std::uint64_t{1} << BlockState<Real>::block) - 1;
  lists.lanes.assign(lists.value.size() + 1, 0);  // never empty: it tells what the lists are
  for (std::size_t k = 0; k + 1 < lists.first.size(); ++k)
    for (std::uint32_t n = lists.first[k]; n < lists.first[k + 1]; ++n)
      lists.lanes[n] = static_cast<std::uint16_t>(
          all & ~bonds.bonded_lanes(piece * blocks_per_piece + k, lists.value[n]));
}

template <class Real>
OffsetLists prune_offsets(const kernel::Functions<Real>& kernel, BlockState<Real>& state,
                          std::size_t piece, const OffsetLists& outer, double range) {
  const auto input = prune_input(state, range);
  std::vector<std::int32_t> values(outer.value);  // what is kept moves to the front
  std::vector<std::uint16_t> lanes(outer.lanes);
  OffsetLists lists;
  lists.first.push_back(0);
  std::uint32_t kept = 0;
  const BlocksOf blocks(piece, state.blocks());
  for (std::size_t k = 0; k + 1 < outer.first.size(); ++k) {
    const auto at = [&](std::uint32_t n) {
      return kernel::Candidates{values.data() + n, lanes.empty() ? nullptr : lanes.data() + n,
                                outer.first[k + 1] - outer.first[k]};
    };
    kept += static_cast<std::uint32_t>(
        kernel.prune(input, blocks.first + k, at(outer.first[k]), at(kept)));
    lists.first.push_back(kept);
  }
  lists.value.assign(values.data(), values.data() + kept);
  if (!lanes.empty()) lists.lanes.assign(lanes.data(), lanes.data() + kept + 1);
  return lists;
}

template void find_boxes(BlockState<double>&, std::size_t, BlockBoxes&);
template void find_boxes(BlockState<float>&, std::size_t, BlockBoxes&);
template OffsetLists find_offsets(const kernel::Functions<double>&, BlockState<double>&,
                                  std::size_t, std::span<const std::uint32_t>, const BlockBoxes&,
                                  double);
template OffsetLists find_offsets(const kernel::Functions<float>&, BlockState<float>&, std::size_t,
                                  std::span<const std::uint32_t>, const BlockBoxes&, double);
template OffsetLists prune_offsets(const kernel::Functions<double>&, BlockState<double>&,
                                   std::size_t, const OffsetLists&, double);
template OffsetLists prune_offsets(const kernel::Functions<float>&, BlockState<float>&, std::size_t,
                                   const OffsetLists&, double);

template void remove_bonded(const BondLists<double>&, std::size_t, OffsetLists&);
template void remove_bonded(const BondLists<float>&, std::size_t, OffsetLists&);

}  // namespace sinew
