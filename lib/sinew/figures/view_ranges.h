// SPDX-License-Identifier: GPL-3.0-or-later
// The ranges of the colors of views, found as the values of all frames pass by: one of each
// quantity, so that all pictures of a run say the same.
//
//     if (ranges.wants(drawn, view)) ranges.add(drawn, view, values);
//     ranges.put(drawn, view);
#pragma once

#include <map>
#include <span>
#include <string>

#include <sinew/core/value_range.h>
#include <sinew/figures/snapshots.h>

namespace sinew {

class RangesOfViews {
 public:
  /// `known`: ranges that the run has; those found are added.
  explicit RangesOfViews(ValueRanges& known) : known_(known) {}

  /// Whether the values of this view, by its place among all, are to be added: neither does the run
  /// know their range, nor does a view before it show the same quantity.
  bool wants(const DrawnView& drawn, std::size_t view);
  void add(const DrawnView& drawn, std::size_t view, std::span<const double> values);
  /// Sets the range of a view after all frames.
  void put(DrawnView& drawn, std::size_t view);

 private:
  ValueRanges& known_;
  std::map<std::string, std::size_t> from_;
  std::map<std::string, RangeFinder> found_;
};

}  // namespace sinew
