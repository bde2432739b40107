// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/lists/order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/parallel.h"

namespace sinew {
namespace {

constexpr std::size_t particles_per_piece = 16384;
constexpr std::size_t columns_per_piece = 64;

/// How columns stand in the body's bounds.
struct Columns {
  int along = 0;                    ///< axis along the columns
  std::array<int, 2> across{1, 2};  ///< the others
  std::array<double, 3> low{};
  double edge = 1;
  std::int64_t rows = 1, places = 1;  ///< columns: rows x places

  std::size_t count() const { return static_cast<std::size_t>(rows * places); }
  /// Rows are walked back and forth.
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
  const double most = 2.0 * static_cast<double>(count) + 1024;  // a stray particle far away
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

}  // namespace sinew
