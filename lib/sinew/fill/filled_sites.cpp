// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/filled_sites.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <sinew/core/parallel.h>
#include <sinew/core/union_find.h>
#include <sinew/fill/detail/near_surface.h>
#include <sinew/fill/fill_limits.h>
#include <sinew/fill/runs.h>

namespace sinew {

namespace {

constexpr double coarse_sites = 50000;
constexpr double well_met = 0.02;  // relative error of a count that is accepted
constexpr int max_rounds = 6;
constexpr double max_shrink = 3;  // more would be many times the requested sites

FilledSites fill_at(const BodySpace& space, const PackOptions& options, double radius) {
  FilledSites filled{lattice_in(space.box, lattice_of(options.packing), radius,
                                space.lattice_origin, space.placement.step()),
                     {},
                     {}};
  if (options.thickness) {
    filled.runs = runs_near(filled.lattice, space.surface.triangles, *options.thickness / 2);
    return filled;
  }
  filled.inside = inside_runs(filled.lattice, space.surface);
  filled.runs = filled.inside.runs;
  const double within = clearance_of(options, radius);
  if (within >= space.box.sizes().minCoeff() / 2)
    filled.runs.clear();  // no point is so deep
  else if (within > 0)
    filled.runs =
        runs_without(filled.runs, runs_near(filled.lattice, space.surface.triangles, within));
  return filled;
}

}  // namespace

BodySpace::BodySpace(const Surface& given, const PackOptions& options)
    : placement(given.triangles.points, options.lattice_axes), surface(given) {
  surface.triangles = placement.to_lattice(given.triangles);
  surface.caps = placement.to_lattice(given.caps);
  surface.walls.triangles = placement.to_lattice(given.walls.triangles);
  box = bounds(surface.triangles.points);
  if (options.lattice_origin) lattice_origin = placement.to_lattice(*options.lattice_origin);
  const Vec3 margin = Vec3::Constant(options.thickness.value_or(0) / 2);
  box = Box(box.min() - margin, box.max() + margin);
}

FilledSites fill_sites(const BodySpace& space, const PackOptions& options, double radius) {
  FilledSites best = fill_at(space, options, radius);
  if (!options.count || best.runs.empty()) return best;
  const auto fraction = [&](const FilledSites& filled) {  // fraction of the wanted count
    return static_cast<double>(count_of(filled.runs)) / *options.count;
  };
  const auto miss = [&](const FilledSites& filled) { return std::abs(std::log(fraction(filled))); };
  double next = best.lattice.radius * std::cbrt(fraction(best));
  for (int round = 0; round < max_rounds && miss(best) > well_met; ++round) {
    FilledSites found = fill_at(space, options, std::max(next, radius / max_shrink));
    if (found.runs.empty()) break;
    next = found.lattice.radius * std::cbrt(fraction(found));
    if (miss(found) < miss(best)) best = std::move(found);
  }
  return best;
}

std::size_t count_of(const std::vector<Run>& runs) {
  std::size_t sum = 0;
  for (const Run& run : runs) sum += run.sites();
  return sum;
}

Points positions_of(const Lattice& lattice, const std::vector<Run>& runs) {
  Points points(count_of(runs));
  for_each_site(runs, [&](std::size_t place, const Run& run, int n) {
    points[place] = lattice.site(run.row, n);
  });
  return points;
}

double clearance_of(const PackOptions& options, double radius) {
  return options.clearance + (options.keep == Keep::sphere ? radius : 0);
}

Lattice coarse_lattice(const Box& box) {
  const double longest = box.sizes().maxCoeff();
  return lattice_in(box, Packing::fcc,
                    std::max(radius_for_count(box.volume(), coarse_sites), longest / 300));
}

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

  /// Adds to the counts of a run's sites, and records the earlier runs that it touches.
  void count(std::size_t index, std::int32_t* neighbors, std::vector<Pair>& pairs) const {
    const Run& run = runs_[index];
    const LatticeRow& row = lattice_.rows[run.row];
    const int k = row.first[2];
    for (const LatticePlace& step : lattice_.nearest(k)) {
      const std::int64_t other = lattice_.row_at(k + step[2], across(row, step));
      if (other < 0) continue;
      const int shift =
          (row.first[0] + step[0] - lattice_.rows[other].first[0]) / lattice_.along[0];
      meet(index, other, shift, neighbors + site_[index], pairs);
    }
  }

 private:
  int across(const LatticeRow& row, const LatticePlace& step) const {
    const int i = row.first[0] + step[0], j = row.first[1] + step[1];
    return lattice_.packing == Packing::fcc ? i - j : j;
  }

  /// Site n of the run has site n + shift of the other row as a neighbor.
  void meet(std::size_t index, std::int64_t row, int shift, std::int32_t* neighbors,
            std::vector<Pair>& pairs) const {
    const Run& run = runs_[index];
    const auto end = runs_.begin() + static_cast<std::ptrdiff_t>(first_run_[row + 1]);
    auto other =
        std::partition_point(runs_.begin() + static_cast<std::ptrdiff_t>(first_run_[row]), end,
                             [&](const Run& before) { return before.last - shift <= run.first; });
    for (; other != end && other->first - shift < run.last; ++other) {
      const int first = std::max(run.first, other->first - shift);
      const int last = std::min(run.last, other->last - shift);
      for (int n = first; n < last; ++n) ++neighbors[n - run.first];
      if (const auto place = static_cast<std::size_t>(other - runs_.begin()); place < index)
        pairs.push_back({static_cast<std::int32_t>(place), static_cast<std::int32_t>(index)});
    }
  }

  const Lattice& lattice_;
  const std::vector<Run>& runs_;
  std::vector<std::size_t> first_run_;  ///< index of each row's first run
  std::vector<std::size_t> site_;       ///< number of sites before each run
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
  result.neighbors.resize(counter.sites());
  std::vector<std::vector<Pair>> pairs((runs.size() + runs_at_a_time - 1) / runs_at_a_time);
  parallel_for(runs.size(), runs_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      counter.count(i, result.neighbors.data(), pairs[begin / runs_at_a_time]);
  });
  join(pairs, runs.size(), result);
  return result;
}

}  // namespace sinew
