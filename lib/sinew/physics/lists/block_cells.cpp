// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/lists/block_cells.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_piece = 16384;  // a multiple of every block
// Rounding (of floats at most) must not put particles just within the range two cells apart.
constexpr double slack = 1 + 1e-5;

using Extent = std::array<double, 6>;  // least of x y z, negated largest of x y z

template <class Coord>
Extent extent_of(const std::array<const Coord*, 3>& x, std::size_t count) {
  const std::size_t pieces = (count + particles_per_piece - 1) / particles_per_piece;
  std::vector<Extent> extents(pieces);
  parallel_for(count, particles_per_piece, [&](std::size_t begin, std::size_t end) {
    Extent& extent = extents[begin / particles_per_piece];
    for (int axis = 0; axis < 3; ++axis) {
      const auto [low, high] = std::minmax_element(x[axis] + begin, x[axis] + end);
      extent[axis] = static_cast<double>(*low);
      extent[3 + axis] = -static_cast<double>(*high);
    }
  });
  Extent all;
  all.fill(std::numeric_limits<double>::infinity());
  for (const Extent& extent : extents)
    for (int k = 0; k < 6; ++k) all[k] = std::min(all[k], extent[k]);
  return all;
}

template <class Real>
auto axes_of(BlockState<Real>& state) {
  const auto arrays = state.arrays();
  using Coord = typename BlockState<Real>::Coord;
  return std::array<const Coord*, 3>{arrays.x[0], arrays.x[1], arrays.x[2]};
}

}  // namespace

template <class Real>
BlockCells::BlockCells(BlockState<Real>& state, double range)
    : block_size_(BlockState<Real>::block), blocks_(state.blocks()) {
  size_cells(state, range);
  assign(state);
  sort();
}

template BlockCells::BlockCells(BlockState<double>&, double);
template BlockCells::BlockCells(BlockState<float>&, double);

template <class Real>
void BlockCells::size_cells(BlockState<Real>& state, double range) {
  edge_ = range * slack;
  if (state.size() == 0) return;
  const Extent extent = extent_of(axes_of(state), state.size());
  low_ = Vec3(extent[0], extent[1], extent[2]);
  const Vec3 size = Vec3(-extent[3], -extent[4], -extent[5]) - low_;
  const auto along = [&](int axis) { return std::floor(size[axis] / edge_) + 1; };
  // A particle far away must not make the table huge: larger cells are correct, only slower.
  const double most = 4.0 * static_cast<double>(state.size()) + 4096;
  while (along(0) * along(1) * along(2) > most) edge_ *= 1.5;
  for (int axis = 0; axis < 3; ++axis) counts_[axis] = static_cast<std::int64_t>(along(axis));
}

template <class Real>
void BlockCells::assign(BlockState<Real>& state) {
  cell_.resize(state.size());
  const auto x = axes_of(state);
  const double inverse = 1 / edge_;
  parallel_for(state.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
    const auto along = [&](std::size_t k, int axis) {
      const double at = (static_cast<double>(x[axis][k]) - low_[axis]) * inverse;
      return std::clamp<std::int64_t>(static_cast<std::int64_t>(at), 0, counts_[axis] - 1);
    };
    for (std::size_t k = begin; k < end; ++k)
      cell_[k] = static_cast<std::uint32_t>((along(k, 2) * counts_[1] + along(k, 1)) * counts_[0] +
                                            along(k, 0));
  });
}

template <class Visit>
void BlockCells::for_each_cell(std::size_t block, Visit&& visit) const {
  std::array<std::uint32_t, 16> distinct;  // no block is larger
  std::size_t count = 0;
  const std::size_t end = std::min((block + 1) * block_size_, cell_.size());
  for (std::size_t k = block * block_size_; k < end; ++k) {
    const auto last = distinct.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::find(distinct.begin(), last, cell_[k]) != last) continue;
    distinct[count++] = cell_[k];
    visit(cell_[k]);
  }
}

void BlockCells::sort() {
  first_.assign(cells() + 1, 0);
  const std::size_t blocks_per_piece = particles_per_piece / block_size_;
  // Threads write in no fixed order: only the set of a cell's blocks is used.
  parallel_for(blocks_, blocks_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block)
      for_each_cell(block, [&](std::uint32_t cell) {
        std::atomic_ref(first_[cell]).fetch_add(1, std::memory_order_relaxed);
      });
  });
  std::uint32_t sum = 0;
  for (std::uint32_t& count : first_) sum += count, count = sum;
  inside_.resize(sum);
  // Filled from the end of each cell: afterwards first_ holds the beginnings.
  parallel_for(blocks_, blocks_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block)
      for_each_cell(block, [&](std::uint32_t cell) {
        const auto place =
            std::atomic_ref(first_[cell]).fetch_sub(1, std::memory_order_relaxed) - 1;
        inside_[place] = static_cast<std::uint32_t>(block);
      });
  });
}

BlockCells::Finder::Finder(const BlockCells& cells)
    : cells_(cells), last_(cells.cells(), 0), found_(cells.blocks_ / 64 + 1, 0) {}

void BlockCells::Finder::mark_row(std::int64_t from, std::int64_t to) {
  for (std::int64_t cell = from; cell <= to; ++cell) {
    if (last_[cell] == now_) continue;
    last_[cell] = now_;
    for (std::uint32_t p = cells_.first_[cell]; p < cells_.first_[cell + 1]; ++p) {
      const std::uint32_t block = cells_.inside_[p], word = block / 64;
      if (found_[word] == 0) words_.push_back(word);
      found_[word] |= std::uint64_t{1} << block % 64;
    }
  }
}

void BlockCells::Finder::mark_around(std::uint32_t cell) {
  const auto& counts = cells_.counts_;
  const std::int64_t i = cell % counts[0], j = cell / counts[0] % counts[1],
                     k = cell / (counts[0] * counts[1]);
  const std::int64_t from = std::max<std::int64_t>(i - 1, 0), to = std::min(i + 1, counts[0] - 1);
  for (std::int64_t kk = std::max<std::int64_t>(k - 1, 0); kk <= std::min(k + 1, counts[2] - 1);
       ++kk)
    for (std::int64_t jj = std::max<std::int64_t>(j - 1, 0); jj <= std::min(j + 1, counts[1] - 1);
         ++jj) {
      const std::int64_t row = (kk * counts[1] + jj) * counts[0];
      mark_row(row + from, row + to);
    }
}

void BlockCells::Finder::mark(std::size_t block) {
  words_.clear();
  now_ = static_cast<std::uint32_t>(block) + 1;
  cells_.for_each_cell(block, [&](std::uint32_t cell) { mark_around(cell); });
  std::sort(words_.begin(), words_.end());
}

}  // namespace sinew
