// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/site_index.h>

#include <algorithm>
#include <numeric>

namespace sinew {

SiteIndex::SiteIndex(const Lattice& lattice, const std::vector<Run>& runs)
    : lattice_(lattice), runs_(runs), first_run_(lattice.rows.size() + 1), site_(runs.size() + 1) {
  for (const Run& run : runs_) ++first_run_[static_cast<std::size_t>(run.row) + 1];
  std::partial_sum(first_run_.begin(), first_run_.end(), first_run_.begin());
  for (std::size_t i = 0; i < runs_.size(); ++i)
    site_[i + 1] = site_[i] + static_cast<std::size_t>(runs_[i].sites());
}

const Run* SiteIndex::run_at(const LatticePlace& place) const {
  const std::int64_t row = lattice_.row_at(place[2], place[0] - place[1]);
  if (row < 0) return nullptr;
  const int n = number_in_row(row, place);
  const auto begin = runs_.begin() + static_cast<std::ptrdiff_t>(first_run_[row]),
             end = runs_.begin() + static_cast<std::ptrdiff_t>(first_run_[row + 1]);
  const auto run =
      std::partition_point(begin, end, [&](const Run& before) { return before.last <= n; });
  return run == end || run->first > n ? nullptr : &*run;
}

std::int64_t SiteIndex::at(const LatticePlace& place) const {
  const Run* run = run_at(place);
  if (run == nullptr) return -1;
  return static_cast<std::int64_t>(site_[static_cast<std::size_t>(run - runs_.data())]) +
         number_in_row(run->row, place) - run->first;
}

std::vector<LatticePlace> places_of(const FilledSites& filled) {
  const Lattice& lattice = filled.lattice;
  std::vector<LatticePlace> places(count_of(filled.runs));
  for_each_site(filled.runs, [&](std::size_t place, const Run& run, int n) {
    const LatticeRow& row = lattice.rows[static_cast<std::size_t>(run.row)];
    for (int axis = 0; axis < 3; ++axis)
      places[place][axis] = row.first[axis] + n * (axis < 2 ? lattice.along[axis] : 0);
  });
  return places;
}

}  // namespace sinew
