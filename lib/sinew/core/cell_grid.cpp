// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/cell_grid.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/parallel.h>

namespace sinew {

namespace {

// Rounding must not put particles just within the range two cells apart.
constexpr double slack = 1 + 1e-9;
constexpr std::size_t points_per_piece = 4096;

std::array<std::vector<double>, 3> split(const Points& points) {
  std::array<std::vector<double>, 3> axes;
  for (auto& axis : axes) axis.resize(points.size());
  parallel_for(points.size(), points_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int axis = 0; axis < 3; ++axis) axes[axis][i] = points[i][axis];
  });
  return axes;
}

Box bounds(std::span<const double> x, std::span<const double> y, std::span<const double> z) {
  Box box;
  for (std::size_t i = 0; i < x.size(); ++i) box.extend(Vec3(x[i], y[i], z[i]));
  return box;
}

}  // namespace

CellGrid::CellGrid(std::span<const double> x, std::span<const double> y, std::span<const double> z,
                   double range) {
  size_cells(bounds(x, y, z), x.size(), range);
  sort(x, y, z);
}

CellGrid::CellGrid(const Points& points, double range) {
  const auto axes = split(points);
  size_cells(bounds(axes[0], axes[1], axes[2]), points.size(), range);
  sort(axes[0], axes[1], axes[2]);
}

void CellGrid::size_cells(const Box& box, std::size_t count, double range) {
  edge_ = range * slack;
  if (box.isEmpty()) return;
  low_ = box.min();
  // A particle far away must not make the table huge: larger cells are correct, only slower.
  const double most = 8.0 * static_cast<double>(count) + 4096;
  const Vec3 size = box.sizes();
  const auto along = [&](int axis) { return std::floor(size[axis] / edge_) + 1; };
  while (along(0) * along(1) * along(2) > most) edge_ *= 1.5;
  for (int axis = 0; axis < 3; ++axis) cells_[axis] = static_cast<std::int64_t>(along(axis));
}

std::array<std::int64_t, 3> CellGrid::cell_of(const Vec3& p) const {
  std::array<std::int64_t, 3> cell;
  for (int axis = 0; axis < 3; ++axis) {
    // Points outside the box have no neighbors beyond one cell of it: clamp before the cast.
    const double at = std::floor((p[axis] - low_[axis]) / edge_);
    cell[axis] =
        static_cast<std::int64_t>(std::clamp(at, -2.0, static_cast<double>(cells_[axis]) + 1));
  }
  return cell;
}

std::uint32_t CellGrid::index_of(double x, double y, double z) const {
  const auto [i, j, k] = cell_of(Vec3(x, y, z));
  return static_cast<std::uint32_t>((k * cells_[1] + j) * cells_[0] + i);
}

void CellGrid::sort(std::span<const double> x, std::span<const double> y,
                    std::span<const double> z) {
  std::vector<std::uint32_t> cell(x.size());
  first_.assign(cells_[0] * cells_[1] * cells_[2] + 1, 0);
  parallel_for(x.size(), points_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) cell[i] = index_of(x[i], y[i], z[i]);
  });
  for (const std::uint32_t c : cell) ++first_[c + 1];
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  order_.resize(x.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < x.size(); ++i)
    order_[next[cell[i]]++] = static_cast<std::uint32_t>(i);
}

int CellGrid::runs_around(const Vec3& p, std::array<Run, 9>& runs) const {
  const auto [i, j, k] = cell_of(p);
  const std::int64_t from = std::max<std::int64_t>(i - 1, 0);
  const std::int64_t to = std::min(i + 1, cells_[0] - 1);
  int count = 0;
  if (from > to) return count;
  for (std::int64_t kk = std::max<std::int64_t>(k - 1, 0); kk <= std::min(k + 1, cells_[2] - 1);
       ++kk)
    for (std::int64_t jj = std::max<std::int64_t>(j - 1, 0); jj <= std::min(j + 1, cells_[1] - 1);
         ++jj) {
      const std::int64_t row = (kk * cells_[1] + jj) * cells_[0];
      runs[count++] = {first_[row + from], first_[row + to + 1]};
    }
  return count;
}

void append_neighbors(const CellGrid& grid, const Points& points, std::size_t i, double range,
                      std::vector<std::uint32_t>& neighbor) {
  const std::size_t begin = neighbor.size();
  grid.for_each_near(points[i], [&](std::uint32_t j) {
    if (j != i && (points[j] - points[i]).squaredNorm() < range * range) neighbor.push_back(j);
  });
  std::sort(neighbor.begin() + static_cast<std::ptrdiff_t>(begin), neighbor.end());
}

NeighborLists neighbors_within(const Points& points, double range) {
  const CellGrid grid(points, range);
  NeighborLists lists;
  lists.first.assign(points.size() + 1, 0);
  std::vector<std::vector<std::uint32_t>> pieces((points.size() + points_per_piece - 1) /
                                                 points_per_piece);
  parallel_for(points.size(), points_per_piece, [&](std::size_t begin, std::size_t end) {
    auto& neighbor = pieces[begin / points_per_piece];
    for (std::size_t i = begin; i < end; ++i) {
      append_neighbors(grid, points, i, range, neighbor);
      lists.first[i + 1] = static_cast<std::uint32_t>(neighbor.size());  // in the piece
    }
  });
  std::uint64_t all = 0;
  for (const auto& piece : pieces) all += piece.size();
  if (all > UINT32_MAX)
    throw bad_input("neighbor lists need over 2^32 entries", "make body.radius larger");
  for (std::size_t begin = points_per_piece; begin < points.size(); begin += points_per_piece)
    for (std::size_t i = begin; i < std::min(begin + points_per_piece, points.size()); ++i)
      lists.first[i + 1] += lists.first[begin];
  lists.neighbor.resize(lists.first.back());
  parallel_for(points.size(), points_per_piece, [&](std::size_t begin, std::size_t) {
    auto& neighbor = pieces[begin / points_per_piece];
    std::copy(neighbor.begin(), neighbor.end(), lists.neighbor.begin() + lists.first[begin]);
    neighbor = std::vector<std::uint32_t>();  // {} would keep its memory
  });
  return lists;
}

}  // namespace sinew
