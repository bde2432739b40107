// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/inside_runs.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/parallel.h>
#include <sinew/fill/detail/closed_sweep.h>
#include <sinew/fill/detail/open_winding.h>

namespace sinew {
namespace {

constexpr std::size_t rows_at_a_time = 64;
constexpr int samples = 4000;

template <class Sweep>
std::vector<SweptRows> all_rows(std::size_t rows, const Sweep& sweep) {
  std::vector<SweptRows> found((rows + rows_at_a_time - 1) / rows_at_a_time);
  parallel_for(rows, rows_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sweep.add_row(i, found[begin / rows_at_a_time]);
  });
  return found;
}

/// Every n-th site, about `samples` of them.
std::vector<RowSite> spread_sites(const Lattice& lattice) {
  const std::uint64_t step = std::max<std::uint64_t>(1, lattice.sites() / samples);
  std::vector<RowSite> chosen;
  std::uint64_t next = step / 2, before = 0;
  for (std::size_t row = 0; row < lattice.rows.size(); ++row) {
    for (; next < before + lattice.rows[row].sites; next += step)
      chosen.push_back({static_cast<std::int32_t>(row), static_cast<std::int32_t>(next - before)});
    before += lattice.rows[row].sites;
  }
  return chosen;
}

}  // namespace

InsideRuns inside_runs(const Lattice& lattice, const Surface& surface) {
  RowCrossings crossings = row_crossings(lattice, surface.triangles);
  if (surface.closed() && !surface.walls.component.empty())
    add_crossings(row_crossings(lattice, surface.walls.triangles),
                  static_cast<int>(surface.triangles.faces.size()), crossings);
  const std::size_t rows = lattice.rows.size();
  const auto found = surface.closed() ? all_rows(rows, ClosedSweep(lattice, surface, crossings))
                                      : all_rows(rows, OpenSweep(lattice, surface, crossings));
  InsideRuns inside;
  for (const SweptRows& piece : found) {
    inside.runs.insert(inside.runs.end(), piece.runs.begin(), piece.runs.end());
    inside.deepest = std::max(inside.deepest, piece.deepest);
    inside.shallowest = std::min(inside.shallowest, piece.shallowest);
  }
  inside.on_surface = std::move(crossings.on_surface);
  if (surface.closed()) number_bodies(found, surface, inside);
  return inside;
}

double ambiguous_fraction(const Lattice& lattice, const Surface& surface) {
  if (surface.closed()) return 0;
  const RowCrossings crossings = row_crossings(lattice, surface.triangles);
  const OpenSweep sweep(lattice, surface, crossings);
  const std::vector<RowSite> chosen = spread_sites(lattice);
  const double unsure =
      parallel_sum(chosen.size(), rows_at_a_time, [&](std::size_t i, std::size_t end) {
        double count = 0;
        for (; i < end; ++i) {
          const double w = sweep.winding(chosen[i].row, chosen[i].site);
          count += std::abs(w - std::round(w)) > 0.1;
        }
        return count;
      });
  return chosen.empty() ? 0 : unsure / static_cast<double>(chosen.size());
}

}  // namespace sinew
