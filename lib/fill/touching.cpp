// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/touching.h"

#include <algorithm>
#include <numeric>

#include "core/parallel.h"
#include "core/union_find.h"

namespace sinew {
namespace {

constexpr std::size_t runs_at_a_time = 256;

using Pair = std::array<std::int32_t, 2>;

class Counter {
 public:
  Counter(const Lattice& lattice, const std::vector<Run>& runs)
      : lattice_(lattice),
        runs_(runs),
        first_run_(lattice.rows.size() + 1),
        site_(runs.size() + 1) {
    for (const Run& run : runs) ++first_run_[run.row + 1];
    std::partial_sum(first_run_.begin(), first_run_.end(), first_run_.begin());
    for (std::size_t i = 0; i < runs.size(); ++i) site_[i + 1] = site_[i] + runs[i].sites();
  }

  std::size_t sites() const { return site_.back(); }

  /// Adds to the counts of a run's sites, and notes the earlier runs that it touches.
  void count(std::size_t index, std::int32_t* neighbours, std::vector<Pair>& pairs) const {
    const Run& run = runs_[index];
    const LatticeRow& row = lattice_.rows[run.row];
    const int k = row.first[2];
    for (const LatticePlace& step : lattice_.nearest(k)) {
      const std::int64_t other = lattice_.row_at(k + step[2], across(row, step));
      if (other < 0) continue;
      const int shift =
          (row.first[0] + step[0] - lattice_.rows[other].first[0]) / lattice_.along[0];
      meet(index, other, shift, neighbours + site_[index], pairs);
    }
  }

 private:
  int across(const LatticeRow& row, const LatticePlace& step) const {
    const int i = row.first[0] + step[0], j = row.first[1] + step[1];
    return lattice_.packing == Packing::fcc ? i - j : j;
  }

  /// Site n of the run has site n + shift of the other row as a neighbour.
  void meet(std::size_t index, std::int64_t row, int shift, std::int32_t* neighbours,
            std::vector<Pair>& pairs) const {
    const Run& run = runs_[index];
    const auto end = runs_.begin() + static_cast<std::ptrdiff_t>(first_run_[row + 1]);
    auto other =
        std::partition_point(runs_.begin() + static_cast<std::ptrdiff_t>(first_run_[row]), end,
                             [&](const Run& before) { return before.last - shift <= run.first; });
    for (; other != end && other->first - shift < run.last; ++other) {
      const int first = std::max(run.first, other->first - shift);
      const int last = std::min(run.last, other->last - shift);
      for (int n = first; n < last; ++n) ++neighbours[n - run.first];
      if (const auto place = static_cast<std::size_t>(other - runs_.begin()); place < index)
        pairs.push_back({static_cast<std::int32_t>(place), static_cast<std::int32_t>(index)});
    }
  }

  const Lattice& lattice_;
  const std::vector<Run>& runs_;
  std::vector<std::size_t> first_run_;  ///< of each row
  std::vector<std::size_t> site_;       ///< before each run
};

/// Numbers the groups by their first run.
void join(const std::vector<std::vector<Pair>>& pairs, std::size_t runs, Touching& result) {
  UnionFind sets(runs);
  for (const auto& piece : pairs)
    for (const auto& [a, b] : piece) sets.join(a, b);
  result.group.resize(runs);
  for (std::size_t i = 0; i < runs; ++i) {
    const std::int32_t first = sets.first_of(static_cast<std::int32_t>(i));
    result.group[i] = first == static_cast<std::int32_t>(i) ? result.groups++ : result.group[first];
  }
}

}  // namespace

Touching touching_sites(const Lattice& lattice, const std::vector<Run>& runs) {
  const Counter counter(lattice, runs);
  Touching result;
  result.neighbours.resize(counter.sites());
  std::vector<std::vector<Pair>> pairs((runs.size() + runs_at_a_time - 1) / runs_at_a_time);
  parallel_for(runs.size(), runs_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      counter.count(i, result.neighbours.data(), pairs[begin / runs_at_a_time]);
  });
  join(pairs, runs.size(), result);
  return result;
}

}  // namespace sinew
