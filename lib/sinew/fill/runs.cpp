// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/runs.h>

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

}  // namespace

std::vector<Run> runs_without(const std::vector<Run>& runs, const std::vector<Run>& others) {
  std::vector<Run> left;
  auto first = others.begin();
  for (Run run : runs) {
    while (first != others.end() && ends_before(*first, run)) ++first;
    for (auto other = first; other != others.end() && !ends_before(run, *other); ++other) {
      push(left, {run.row, run.first, other->first, run.body});
      run.first = other->last;
    }
    push(left, run);
  }
  return left;
}

}  // namespace sinew
