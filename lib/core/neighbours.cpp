// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/neighbours.h"

#include <algorithm>

#include "core/cell_grid.h"
#include "core/error.h"
#include "core/parallel.h"

namespace sinew {
namespace {

constexpr std::size_t points_per_piece = 4096;

/// Adds the partners of point i, ascending.
void add_row(const CellGrid& grid, const Points& points, std::size_t i, double range,
             std::vector<std::uint32_t>& partner) {
  const std::size_t begin = partner.size();
  grid.for_each_near(points[i], [&](std::uint32_t j) {
    if (j != i && (points[j] - points[i]).squaredNorm() < range * range) partner.push_back(j);
  });
  std::sort(partner.begin() + static_cast<std::ptrdiff_t>(begin), partner.end());
}

}  // namespace

NeighbourLists neighbours_within(const Points& points, double range) {
  const CellGrid grid(points, range);
  NeighbourLists lists;
  lists.first.assign(points.size() + 1, 0);
  std::vector<std::vector<std::uint32_t>> pieces((points.size() + points_per_piece - 1) /
                                                 points_per_piece);
  parallel_for(points.size(), points_per_piece, [&](std::size_t begin, std::size_t end) {
    auto& partner = pieces[begin / points_per_piece];
    for (std::size_t i = begin; i < end; ++i) {
      add_row(grid, points, i, range, partner);
      lists.first[i + 1] = static_cast<std::uint32_t>(partner.size());  // within the piece
    }
  });
  std::uint64_t all = 0;
  for (const auto& piece : pieces) all += piece.size();
  if (all > UINT32_MAX)
    throw bad_input("lists of neighbours need over 2^32 entries", "make body.radius larger");
  for (std::size_t begin = points_per_piece; begin < points.size(); begin += points_per_piece)
    for (std::size_t i = begin; i < std::min(begin + points_per_piece, points.size()); ++i)
      lists.first[i + 1] += lists.first[begin];
  lists.partner.resize(lists.first.back());
  parallel_for(points.size(), points_per_piece, [&](std::size_t begin, std::size_t) {
    auto& partner = pieces[begin / points_per_piece];
    std::copy(partner.begin(), partner.end(), lists.partner.begin() + lists.first[begin]);
    partner = {};
  });
  return lists;
}

}  // namespace sinew
