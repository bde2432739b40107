// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/body/pass_through.h>

#include <algorithm>

namespace sinew {

PassThrough::PassThrough(std::size_t bones, const std::vector<Pair>& pairs) {
  for (const auto& [a, b] : pairs)
    if (a != b) pairs_.push_back({std::min(a, b), std::max(a, b)});
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  if (pairs_.empty()) return;
  has_.assign(bones, false);
  passes_.assign(bones * bones, false);
  for (const auto& [first, second] : pairs_) {
    const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(second);
    has_[a] = has_[b] = true;
    passes_[a * bones + b] = passes_[b * bones + a] = true;
  }
}

}  // namespace sinew
