// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/figures/view_ranges.h>

namespace sinew {
namespace {

std::string key_of(const DrawnView& drawn, std::size_t view) {
  const std::string quantity = drawn.quantity();
  return quantity.empty() ? ' ' + std::to_string(view) : quantity;
}

}  // namespace

bool RangesOfViews::wants(const DrawnView& drawn, std::size_t view) {
  const std::string key = key_of(drawn, view);
  return !drawn.pulls && !known_.contains(key) &&
         from_.try_emplace(key, view).first->second == view;
}

void RangesOfViews::add(const DrawnView& drawn, std::size_t view, std::span<const double> values) {
  found_[key_of(drawn, view)].add(values);
}

void RangesOfViews::put(DrawnView& drawn, std::size_t view) {
  const std::string key = key_of(drawn, view);
  if (const auto known = known_.find(key); known != known_.end()) drawn.range = known->second;
  const auto found = found_.find(key);
  if (found == found_.end() || found->second.empty()) return;
  drawn.range = found->second.range();
  if (drawn.preset.view == View::curves) drawn.range.low = 0;
  if (!drawn.quantity().empty()) known_[key] = drawn.range;
}

}  // namespace sinew
