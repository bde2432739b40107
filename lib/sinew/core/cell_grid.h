// SPDX-License-Identifier: GPL-3.0-or-later
// The cell grid of Komiya and Tokoi: space is cut into cells whose edge is the interaction range,
// so that all neighbors of a particle are in its own and the 26 adjacent cells. The number of
// particles per cell is not limited.
//
//     const NeighborLists lists = neighbors_within(points, range);
//     for (const std::uint32_t j : lists.of(i)) visit(points[j]);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

class CellGrid {
 public:
  /// Sorts the points (each span n long, finite, m) into cells of edge `range` (> 0) or larger.
  CellGrid(std::span<const double> x, std::span<const double> y, std::span<const double> z,
           double range);
  CellGrid(const Points& points, double range);

  /// Calls visit(j) for every point j in the cells around `p`: all within the range, and others.
  template <class Visit>
  void for_each_near(const Vec3& p, Visit&& visit) const {
    std::array<Run, 9> runs;
    const int count = runs_around(p, runs);
    for (int run = 0; run < count; ++run)
      for (std::uint32_t slot = runs[run].begin; slot < runs[run].end; ++slot) visit(order_[slot]);
  }

 private:
  struct Run {
    std::uint32_t begin, end;
  };

  std::array<std::int64_t, 3> cell_of(const Vec3& p) const;
  std::uint32_t index_of(double x, double y, double z) const;
  /// Cells adjacent along x hold their points in one run: 9 runs are 27 cells.
  int runs_around(const Vec3& p, std::array<Run, 9>& runs) const;
  void size_cells(const Box& box, std::size_t count, double range);
  void sort(std::span<const double> x, std::span<const double> y, std::span<const double> z);

  Vec3 low_ = Vec3::Zero();
  double edge_ = 0;
  std::array<std::int64_t, 3> cells_{1, 1, 1};
  std::vector<std::uint32_t> first_;  ///< where each cell's points begin in order_
  std::vector<std::uint32_t> order_;  ///< points sorted by cell; ascending within a cell
};

// Lists of the points within a distance of each point, all in one array.

/// Row i of a list of lists: the neighbors of point i, ascending.
struct NeighborLists {
  std::vector<std::uint32_t> first;     ///< n + 1 long; row i is [first[i], first[i + 1])
  std::vector<std::uint32_t> neighbor;  ///< indices of points

  std::size_t size() const { return first.empty() ? 0 : first.size() - 1; }
  std::span<const std::uint32_t> of(std::size_t i) const {
    return {neighbor.data() + first[i], first[i + 1] - first[i]};
  }
};

/// Every pair closer than `range` (m), in both directions. Same result as brute force. Throws bad
/// input for more than 2^32 of them. In parallel.
NeighborLists neighbors_within(const Points& points, double range);
/// Appends the neighbors of point i among those of the grid, ascending.
void append_neighbors(const CellGrid& grid, const Points& points, std::size_t i, double range,
                      std::vector<std::uint32_t>& neighbor);

}  // namespace sinew
