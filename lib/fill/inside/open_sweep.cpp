// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/inside/open_sweep.h"

#include <algorithm>
#include <cmath>

namespace sinew {
namespace {

/// A site that was looked at.
struct Looked {
  int site;
  double margin;     ///< of the winding number above one half
  double clearance;  ///< from the border, in sites
};

/// Away from the border the winding number is smooth: where two places are no farther from each
/// other than from the border, and their margins differ by little, those between have their sign.
bool smooth_between(const Looked& a, const Looked& b) {
  const double least = std::min(std::abs(a.margin), std::abs(b.margin));
  return std::abs(a.margin - b.margin) < least / 4 && b.site - a.site < a.clearance + b.clearance;
}

/// The sites between two, of which neither is the first or the last.
template <class Look>
void between(const Looked& a, const Looked& b, const Look& look, RowRuns& runs) {
  if (b.site - a.site < 2) return;
  if (smooth_between(a, b)) {
    if (a.margin > 0) runs.add(a.site + 1, b.site, 0);
    return;
  }
  const Looked middle = look(a.site + (b.site - a.site) / 2);
  between(a, middle, look, runs);
  if (middle.margin > 0) runs.add(middle.site, middle.site + 1, 0);
  between(middle, b, look, runs);
}

/// In steps that double away from both ends of first .. last - 1.
std::vector<int> doubling_from_both_ends(int first, int last) {
  std::vector<int> sites = {first, last - 1};
  for (int step = 1; step < (last - first) / 2; step *= 2) {
    sites.push_back(first + step);
    sites.push_back(last - 1 - step);
  }
  std::sort(sites.begin(), sites.end());
  sites.erase(std::unique(sites.begin(), sites.end()), sites.end());
  return sites;
}

}  // namespace

OpenSweep::OpenSweep(const Lattice& lattice, const Surface& surface, const RowCrossings& crossings)
    : lattice_(lattice),
      crossings_(crossings),
      cap_crossings_(row_crossings(lattice, surface.caps)),
      winding_(lattice, surface.caps, cap_crossings_) {}

void OpenSweep::add_row(std::size_t row, SweptRows& found) const {
  RowRuns runs(row, crossings_.on_surface, found.runs);
  int sum = 0, from = 0;
  for (const Crossing& one : crossings_.of(row)) {
    add_between(row, from, one.site, sum, runs);
    from = one.site;
    sum += one.winding;
  }
  add_between(row, from, lattice_.rows[row].sites, sum, runs);
}

double OpenSweep::winding(std::size_t row, int site) const {
  int sum = 0;
  for (const Crossing& one : crossings_.of(row))
    if (one.site <= site) sum += one.winding;
  return sum + (winding_.none() ? 0 : winding_.share(row, site, {0.02, 1e9}).value);
}

/// Between two crossings the winding number changes smoothly, faster near the surface: looked at
/// in steps that double away from both ends, then between them where a doubt is left.
void OpenSweep::add_between(std::size_t row, int first, int last, int sum, RowRuns& runs) const {
  if (first >= last) return;
  const std::vector<int> sites = doubling_from_both_ends(first, last);
  const auto look = [&](int site) {
    const auto [value, clearance] = winding_.share(row, site, {0.001, 0.5 - sum});
    return Looked{site, sum - 0.5 + value, clearance / (2 * lattice_.radius)};
  };
  Looked before = look(sites[0]);
  if (before.margin > 0) runs.add(before.site, before.site + 1, 0);
  for (std::size_t i = 1; i < sites.size(); ++i) {
    const Looked next = look(sites[i]);
    between(before, next, look, runs);
    if (next.margin > 0) runs.add(next.site, next.site + 1, 0);
    before = next;
  }
}

}  // namespace sinew
