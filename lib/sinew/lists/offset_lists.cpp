// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/offset_lists.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>

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

/// Clears the bounds of the blocks from `first` on, which do not exist.
void clear(kernel::BlockBounds& bounds, std::size_t first) {
  constexpr float never = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < kernel::bound_axes; ++axis) {
    std::fill(bounds.low[axis] + first, std::end(bounds.low[axis]), never);
    std::fill(bounds.high[axis] + first, std::end(bounds.high[axis]), -never);
  }
}

/// The one around all of them.
void unite(const kernel::BlockBounds& from, std::size_t at, kernel::BlockBounds& bounds) {
  for (int axis = 0; axis < kernel::bound_axes; ++axis) {
    bounds.low[axis][at] = *std::min_element(from.low[axis], std::end(from.low[axis]));
    bounds.high[axis][at] = *std::max_element(from.high[axis], std::end(from.high[axis]));
  }
}

/// Around some pieces, as if each were a block.
std::vector<kernel::BlockBounds> bounds_of(std::span<const std::uint32_t> pieces,
                                           const BlockBoxes& boxes) {
  std::vector<kernel::BlockBounds> bounds((pieces.size() + blocks_per_piece - 1) /
                                          blocks_per_piece);
  if (!bounds.empty()) clear(bounds.back(), 0);
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
void find_boxes(const kernel::Functions<Real>& kernel, BlockState<Real>& state, std::size_t piece,
                BlockBoxes& boxes) {
  const BlocksOf blocks(piece, state.blocks());
  kernel::BlockBounds& bounds = boxes.of_blocks[piece];
  kernel.bound(state.arrays(), piece, state.size(), bounds);
  clear(bounds, blocks.last - blocks.first);
  unite(bounds, piece % blocks_per_piece, boxes.of_pieces[piece / blocks_per_piece]);
}

template <class Real>
OffsetLists find_offsets(const kernel::Functions<Real>& kernel, BlockState<Real>& state,
                         std::size_t piece, std::span<const std::uint32_t> near,
                         const BlockBoxes& boxes, double range) {
  constexpr std::size_t size = BlockState<Real>::block;
  const std::size_t room = near.size() * blocks_per_piece;
  const std::vector<kernel::BlockBounds> around = bounds_of(near, boxes);
  const auto places = std::make_unique_for_overwrite<float[]>(room * 4 * size);
  const auto others = std::make_unique_for_overwrite<kernel::NearBlock[]>(room);
  const auto differences = std::make_unique_for_overwrite<std::int32_t[]>(2 * room * 2 * size);
  std::int32_t* const found[] = {differences.get(), differences.get() + room * 2 * size};
  std::vector<std::uint8_t> placed(room, 0);
  const BlocksOf blocks(piece, state.blocks());
  const auto own = std::lower_bound(near.begin(), near.end(), piece) - near.begin();
  kernel::ListInput<Real> input{state.arrays(),
                                near.data(),
                                near.size(),
                                static_cast<std::size_t>(own),
                                boxes.of_blocks.data(),
                                around.data(),
                                static_cast<float>(range * (1 + 1e-6)),
                                {},
                                places.get(),
                                placed.data()};
  const std::size_t middle = (blocks.first + blocks.last) / 2 * size;
  for (int axis = 0; axis < 3; ++axis) input.center[axis] = input.state.x[axis][middle];
  OffsetLists lists;
  lists.first.push_back(0);
  for (std::size_t block = blocks.first; block < blocks.last; block += 2) {
    std::size_t counts[2];
    kernel.list(input, block, others.get(), found, counts);
    for (std::size_t n = 0; n < 2 && block + n < blocks.last; ++n) {
      lists.value.insert(lists.value.end(), found[n], found[n] + counts[n]);
      lists.first.push_back(static_cast<std::uint32_t>(lists.value.size()));
    }
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

template void find_boxes(const kernel::Functions<double>&, BlockState<double>&, std::size_t,
                         BlockBoxes&);
template void find_boxes(const kernel::Functions<float>&, BlockState<float>&, std::size_t,
                         BlockBoxes&);
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
