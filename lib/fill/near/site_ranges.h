// SPDX-License-Identifier: GPL-3.0-or-later
// The sites of one row, put together from ranges that come in any order.
#pragma once

#include <algorithm>
#include <vector>

#include "fill/near/row_ranges.h"
#include "fill/runs.h"

namespace sinew {

class SiteRanges {
 public:
  /// Whether the last one added has them all.
  bool has(IndexRange sites) const {
    return !ranges_.empty() && ranges_.back().first <= sites.first &&
           sites.last <= ranges_.back().last;
  }

  void add(IndexRange sites) {
    if (sites.first >= sites.last) return;
    if (!ranges_.empty() && touch(ranges_.back(), sites))
      ranges_.back() = joined(ranges_.back(), sites);
    else
      ranges_.push_back(sites);
  }

  /// As runs of body 0, by site, none touching.
  void append_to(std::vector<Run>& runs, std::size_t row) {
    std::sort(ranges_.begin(), ranges_.end(),
              [](const IndexRange& a, const IndexRange& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < ranges_.size();) {
      IndexRange all = ranges_[i++];
      for (; i < ranges_.size() && touch(all, ranges_[i]); ++i) all = joined(all, ranges_[i]);
      runs.push_back({static_cast<std::int32_t>(row), all.first, all.last, 0});
    }
  }

 private:
  static bool touch(IndexRange a, IndexRange b) { return a.first <= b.last && b.first <= a.last; }
  static IndexRange joined(IndexRange a, IndexRange b) {
    return {std::min(a.first, b.first), std::max(a.last, b.last)};
  }

  std::vector<IndexRange> ranges_;
};

}  // namespace sinew
