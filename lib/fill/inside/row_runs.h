// SPDX-License-Identifier: GPL-3.0-or-later
// The runs inside a surface as a sweep along the rows of a lattice collects them.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "fill/inside/row_crossings.h"
#include "fill/runs.h"

namespace sinew {

/// What a piece of the rows came to.
struct SweptRows {
  std::vector<Run> runs;
  std::vector<std::array<int, 2>> overlaps;  ///< components that share a site
  int deepest = 0, shallowest = 0;           ///< winding numbers; of closed surfaces only
};

/// Collects runs of one row and leaves out the sites on the surface.
class RowRuns {
 public:
  RowRuns(std::size_t row, const std::vector<RowSite>& on_surface, std::vector<Run>& runs)
      : row_(static_cast<std::int32_t>(row)),
        runs_(runs),
        next_(std::lower_bound(on_surface.begin(), on_surface.end(), RowSite{row_, 0})),
        end_(on_surface.end()) {}

  /// Sites first .. last - 1 lie inside. Calls come in the order of the sites.
  void add(int first, int last, int body) {
    while (next_ != end_ && next_->row == row_ && next_->site < last) {
      push(first, next_->site, body);
      first = std::max(first, next_->site + 1);
      ++next_;
    }
    push(first, last, body);
  }

 private:
  void push(int first, int last, int body) {
    if (first >= last) return;
    const bool follows = !runs_.empty() && runs_.back().row == row_ && runs_.back().last == first &&
                         runs_.back().body == body;
    follows ? void(runs_.back().last = last) : runs_.push_back({row_, first, last, body});
  }

  std::int32_t row_;
  std::vector<Run>& runs_;
  std::vector<RowSite>::const_iterator next_, end_;
};

}  // namespace sinew
