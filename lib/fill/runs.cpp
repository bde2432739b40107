// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/runs.h"

#include <algorithm>

namespace sinew {
namespace {

void push(std::vector<Run>& runs, const Run& run) {
  if (run.first >= run.last) return;
  const bool follows = !runs.empty() && runs.back().row == run.row &&
                       runs.back().last == run.first && runs.back().body == run.body;
  follows ? void(runs.back().last = run.last) : runs.push_back(run);
}

bool ends_before(const Run& a, const Run& b) {
  return a.row < b.row || (a.row == b.row && a.last <= b.first);
}

/// Calls visit(run, overlapping) for each run with those of `others` that share sites with it.
template <class Visit>
void with_overlapping(const std::vector<Run>& runs, const std::vector<Run>& others,
                      const Visit& visit) {
  auto first = others.begin();
  for (const Run& run : runs) {
    while (first != others.end() && ends_before(*first, run)) ++first;
    auto last = first;
    while (last != others.end() && !ends_before(run, *last)) ++last;
    visit(run, first, last);
  }
}

}  // namespace

std::vector<Run> runs_without(const std::vector<Run>& runs, const std::vector<Run>& others) {
  std::vector<Run> left;
  with_overlapping(runs, others, [&](Run run, auto other, auto end) {
    for (; other != end; ++other) {
      push(left, {run.row, run.first, other->first, run.body});
      run.first = other->last;
    }
    push(left, run);
  });
  return left;
}

std::vector<Run> runs_within(const std::vector<Run>& runs, const std::vector<Run>& others) {
  std::vector<Run> common;
  with_overlapping(runs, others, [&](const Run& run, auto other, auto end) {
    for (; other != end; ++other)
      push(common,
           {run.row, std::max(run.first, other->first), std::min(run.last, other->last), run.body});
  });
  return common;
}

}  // namespace sinew
