// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/lists/offset_lists.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <mutex>
#include <numeric>

#include <sinew/core/error.h>
#include <sinew/core/parallel.h>

namespace sinew {

namespace {

constexpr std::size_t particles_per_piece = 16384;
constexpr std::size_t columns_per_piece = 64;

/// How columns divide the body's bounding box.
struct Columns {
  int along = 0;                    ///< axis along the columns
  std::array<int, 2> across{1, 2};  ///< the others
  std::array<double, 3> low{};
  double edge = 1;
  std::int64_t rows = 1, places = 1;  ///< columns: rows x places

  std::size_t count() const { return static_cast<std::size_t>(rows * places); }
  /// Rows run back and forth.
  std::uint32_t of(double a, double b) const {
    const auto row = std::min(static_cast<std::int64_t>((a - low[across[0]]) / edge), rows - 1);
    const auto at = std::min(static_cast<std::int64_t>((b - low[across[1]]) / edge), places - 1);
    return static_cast<std::uint32_t>(row * places + (row % 2 == 0 ? at : places - 1 - at));
  }
};

template <class Coord>
Columns columns_of(const std::array<Coord*, 3>& x, std::size_t count, double edge) {
  Columns columns;
  std::array<double, 3> size{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax_element(x[axis], x[axis] + count);
    columns.low[axis] = static_cast<double>(*low);
    size[axis] = static_cast<double>(*high) - columns.low[axis];
  }
  columns.along = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  columns.across = {(columns.along + 1) % 3, (columns.along + 2) % 3};
  columns.edge = edge;
  const double most = 2.0 * static_cast<double>(count) + 1024;  // a particle may be far away
  const auto along = [&](int side) {
    return std::floor(size[columns.across[side]] / columns.edge) + 1;
  };
  while (along(0) * along(1) > most) columns.edge *= 1.5;
  columns.rows = static_cast<std::int64_t>(along(0));
  columns.places = static_cast<std::int64_t>(along(1));
  return columns;
}

}  // namespace

template <class Real>
std::vector<std::uint32_t> order_by_columns(BlockState<Real>& state, double edge) {
  const std::size_t n = state.size();
  const auto arrays = state.arrays();
  const std::array x{arrays.x[0], arrays.x[1], arrays.x[2]};
  const Columns columns = columns_of(x, n, edge);
  std::vector<std::uint32_t> column(n), first(columns.count() + 1, 0), order(n);
  parallel_for(n, particles_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      column[k] = columns.of(static_cast<double>(x[columns.across[0]][k]),
                             static_cast<double>(x[columns.across[1]][k]));
  });
  for (const std::uint32_t c : column) ++first[c + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::size_t k = 0; k < n; ++k) order[next[column[k]]++] = static_cast<std::uint32_t>(k);
  const auto* along = x[columns.along];
  parallel_for(columns.count(), columns_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      std::sort(order.begin() + first[c], order.begin() + first[c + 1],
                [&](std::uint32_t a, std::uint32_t b) {
                  return along[a] != along[b] ? along[a] < along[b] : a < b;
                });
  });
  return order;
}

template <class Real>
void reorder(BlockState<Real>& from, const std::vector<std::uint32_t>& order,
             BlockState<Real>& to) {
  const auto a = from.arrays(), b = to.arrays();
  parallel_for(order.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t k = begin; k < end; ++k) {
        b.x[axis][k] = a.x[axis][order[k]];
        b.v[axis][k] = a.v[axis][order[k]];
      }
  });
  to.pad();
}

template std::vector<std::uint32_t> order_by_columns(BlockState<double>&, double);
template std::vector<std::uint32_t> order_by_columns(BlockState<float>&, double);
template void reorder(BlockState<double>&, const std::vector<std::uint32_t>&, BlockState<double>&);
template void reorder(BlockState<float>&, const std::vector<std::uint32_t>&, BlockState<float>&);

namespace {

constexpr std::size_t blocks_per_piece = 1024;

/// Makes lists piece by piece: fill(begin, end, lists) appends those of the blocks [begin, end).
template <class Fill>
OffsetLists in_pieces(std::size_t blocks, Fill&& fill) {
  const std::size_t pieces = (blocks + blocks_per_piece - 1) / blocks_per_piece;
  std::vector<OffsetLists> parts(pieces);
  parallel_for(blocks, blocks_per_piece, [&](std::size_t begin, std::size_t end) {
    fill(begin, end, parts[begin / blocks_per_piece]);
  });
  if (pieces == 1) {
    parts[0].first.insert(parts[0].first.begin(), 0);
    return std::move(parts[0]);
  }
  std::vector<std::uint32_t> start(pieces + 1, 0);
  std::uint64_t all = 0;
  for (std::size_t p = 0; p < pieces; ++p) {
    all += parts[p].value.size();
    start[p + 1] = static_cast<std::uint32_t>(all);
  }
  if (all > UINT32_MAX)
    throw bad_input("neighbor lists need over 2^32 entries",
                    "make body.radius larger, or use solver.precision single");
  OffsetLists lists;
  lists.first.resize(blocks + 1, 0);
  lists.value.resize(start[pieces]);
  parallel_for(pieces, 1, [&](std::size_t p, std::size_t) {
    const OffsetLists& part = parts[p];
    std::copy(part.value.begin(), part.value.end(), lists.value.begin() + start[p]);
    for (std::size_t k = 0; k < part.first.size(); ++k)
      lists.first[p * blocks_per_piece + k + 1] = start[p] + part.first[k];
    parts[p] = {};
  });
  return lists;
}

/// One finder per concurrent thread: each stores an entry per cell and per block.
class Finders {
 public:
  explicit Finders(const BlockCells& cells) : cells_(cells) {}

  std::unique_ptr<BlockCells::Finder> take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<BlockCells::Finder>(cells_);
    auto finder = std::move(idle_.back());
    idle_.pop_back();
    return finder;
  }

  void give_back(std::unique_ptr<BlockCells::Finder> finder) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(finder));
  }

 private:
  const BlockCells& cells_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<BlockCells::Finder>> idle_;
};

/// Room for `count` more values at the end.
std::int32_t* room_for(OffsetLists& part, std::size_t used, std::int64_t count) {
  const std::size_t needed = used + static_cast<std::size_t>(count) + 1;
  if (part.value.size() < needed) part.value.resize(std::max(needed, part.value.size() * 3 / 2));
  return part.value.data() + used;
}

template <class Real>
kernel::PruneInput<Real> prune_input(BlockState<Real>& state, double range) {
  return {state.arrays(), static_cast<Real>(range * range)};
}

/// Bounding box of each block's particles.
template <class Real>
std::vector<std::array<float, 6>> boxes_of(BlockState<Real>& state) {
  constexpr std::size_t size = BlockState<Real>::block;
  std::vector<std::array<float, 6>> boxes(state.blocks());
  const auto arrays = state.arrays();
  parallel_for(boxes.size(), blocks_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block)
      for (int axis = 0; axis < 3; ++axis) {
        const auto* first = arrays.x[axis] + block * size;
        const auto* last = arrays.x[axis] + std::min((block + 1) * size, state.size());
        const auto [low, high] = std::minmax_element(first, last);
        boxes[block][axis] = static_cast<float>(*low);
        boxes[block][3 + axis] = static_cast<float>(*high);
      }
  });
  return boxes;
}

bool in_range(const std::array<float, 6>& a, const std::array<float, 6>& b, float range) {
  for (int axis = 0; axis < 3; ++axis) {
    // Bounds were rounded to floats.
    const float slack = 4e-7F * (std::abs(a[axis]) + std::abs(b[3 + axis])) + range;
    if (a[axis] - b[3 + axis] > slack || b[axis] - a[3 + axis] > slack) return false;
  }
  return true;
}

/// Joins consecutive blocks into runs: each is one range of differences.
class Runs {
 public:
  template <class Prune>
  void add(std::uint32_t block, Prune&& prune) {
    if (end_ == block && begin_ != end_) {
      ++end_;
      return;
    }
    flush(prune);
    begin_ = block, end_ = block + 1;
  }
  template <class Prune>
  void flush(Prune&& prune) {
    if (begin_ != end_) prune(begin_, end_);
    begin_ = end_ = 0;
  }

 private:
  std::uint32_t begin_ = 0, end_ = 0;
};

/// Appends the lists of the blocks [begin, end) with the differences added to them.
void copy_with(const OffsetLists& lists, const std::vector<BlockOffset>& added, std::size_t begin,
               std::size_t end, OffsetLists& part) {
  const auto place = [&](std::size_t block) {
    return std::lower_bound(added.begin(), added.end(),
                            BlockOffset{static_cast<std::uint32_t>(block), INT32_MIN});
  };
  const auto last = place(end);
  part.first.reserve(end - begin + 1);
  part.value.reserve(lists.first[end] - lists.first[begin] +
                     static_cast<std::size_t>(last - place(begin)));
  auto next = place(begin);
  for (std::size_t block = begin; block < end; ++block) {
    const auto old = lists.value.begin() + lists.first[block];
    const auto old_end = lists.value.begin() + lists.first[block + 1];
    std::vector<std::int32_t> more;
    for (; next != last && next->block == block; ++next) more.push_back(next->offset);
    if (more.empty())
      part.value.insert(part.value.end(), old, old_end);
    else
      std::set_union(old, old_end, more.begin(), more.end(), std::back_inserter(part.value));
    part.first.push_back(static_cast<std::uint32_t>(part.value.size()));
  }
}

}  // namespace

double OffsetLists::mean() const {
  return first.size() < 2
             ? 0
             : static_cast<double>(value.size()) / static_cast<double>(first.size() - 1);
}

OffsetLists with_added(const OffsetLists& lists, std::vector<BlockOffset> added) {
  if (added.empty()) return lists;
  std::sort(added.begin(), added.end());
  added.erase(std::unique(added.begin(), added.end()), added.end());
  return in_pieces(lists.first.size() - 1,
                   [&](std::size_t begin, std::size_t end, OffsetLists& part) {
                     copy_with(lists, added, begin, end, part);
                   });
}

template <class Real>
OffsetLists find_offsets(const kernel::Functions<Real>& kernel, BlockState<Real>& state,
                         const BlockCells& cells, double range) {
  constexpr std::int64_t size = BlockState<Real>::block;
  const auto input = prune_input(state, range);
  const auto boxes = boxes_of(state);
  const auto reach = static_cast<float>(range * (1 + 1e-6));
  Finders finders(cells);
  return in_pieces(state.blocks(), [&](std::size_t begin, std::size_t end, OffsetLists& part) {
    auto finder = finders.take();
    std::size_t used = 0;
    for (std::size_t block = begin; block < end; ++block) {
      const auto prune = [&](std::uint32_t from, std::uint32_t to) {
        const auto here = static_cast<std::int64_t>(block);
        const std::int64_t low = (from - here) * size - (size - 1);
        const std::int64_t high = (to - here) * size;
        std::int32_t* kept = room_for(part, used, high - low);
        used = kernel.prune_range(input, block, low, high, kept) - part.value.data();
      };
      Runs runs;
      finder->for_each_around(block, [&](std::uint32_t other) {
        if (in_range(boxes[block], boxes[other], reach)) runs.add(other, prune);
      });
      runs.flush(prune);
      part.first.push_back(static_cast<std::uint32_t>(used));
    }
    part.value.resize(used);
    finders.give_back(std::move(finder));
  });
}

template <class Real>
OffsetLists prune_offsets(const kernel::Functions<Real>& kernel, BlockState<Real>& state,
                          const OffsetLists& outer, double range) {
  const auto input = prune_input(state, range);
  return in_pieces(state.blocks(), [&](std::size_t begin, std::size_t end, OffsetLists& part) {
    part.value.resize(outer.first[end] - outer.first[begin] + 1);
    std::int32_t* kept = part.value.data();
    for (std::size_t block = begin; block < end; ++block) {
      kept = kernel.prune(input, block, outer.value.data() + outer.first[block],
                          outer.value.data() + outer.first[block + 1], kept);
      part.first.push_back(static_cast<std::uint32_t>(kept - part.value.data()));
    }
    part.value.resize(static_cast<std::size_t>(kept - part.value.data()));
  });
}

template OffsetLists find_offsets(const kernel::Functions<double>&, BlockState<double>&,
                                  const BlockCells&, double);
template OffsetLists find_offsets(const kernel::Functions<float>&, BlockState<float>&,
                                  const BlockCells&, double);
template OffsetLists prune_offsets(const kernel::Functions<double>&, BlockState<double>&,
                                   const OffsetLists&, double);
template OffsetLists prune_offsets(const kernel::Functions<float>&, BlockState<float>&,
                                   const OffsetLists&, double);

}  // namespace sinew
