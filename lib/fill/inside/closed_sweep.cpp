// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/inside/closed_sweep.h"

#include <algorithm>

#include "fill/inside/depths.h"

namespace sinew {
namespace {

/// Many parts that overlap in many rows do so in the same pairs.
void drop_repeated(std::vector<std::array<int, 2>>& overlaps) {
  constexpr std::size_t many = 4096;
  if (overlaps.size() < many) return;
  std::sort(overlaps.begin(), overlaps.end());
  overlaps.erase(std::unique(overlaps.begin(), overlaps.end()), overlaps.end());
}

void take(RowRuns& runs, int first, int last, int sum, Depths& depths, SweptRows& found) {
  if (first >= last) return;
  found.deepest = std::max(found.deepest, sum);
  found.shallowest = std::min(found.shallowest, sum);
  if (sum > 0) runs.add(first, last, depths.body(found.overlaps));
}

}  // namespace

ClosedSweep::ClosedSweep(const Lattice& lattice, const Surface& surface,
                         const RowCrossings& crossings)
    : lattice_(lattice), surface_(surface), crossings_(crossings) {
  if (surface.components > 1) owner_ = owners_of(surface, crossings);
}

void ClosedSweep::add_row(std::size_t row, SweptRows& found) const {
  RowRuns runs(row, crossings_.on_surface, found.runs);
  Depths depths;
  int sum = 0, from = 0;
  for (const Crossing& one : crossings_.of(row)) {
    take(runs, from, one.site, sum, depths, found);
    from = one.site;
    sum += one.winding;
    if (!owner_.empty()) depths.cross(owner_[surface_.component[one.face]], one.winding);
  }
  take(runs, from, lattice_.rows[row].sites, sum, depths, found);
  drop_repeated(found.overlaps);
}

}  // namespace sinew
