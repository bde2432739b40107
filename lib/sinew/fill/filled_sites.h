// SPDX-License-Identifier: GPL-3.0-or-later
// Selects the sites of a lattice that become particles, and counts their nearest neighbors.
//
//     const FilledSites filled = fill_sites(BodySpace(surface, options), options, radius);
#pragma once

#include <cstdint>
#include <vector>

#include <sinew/core/parallel.h>
#include <sinew/fill/inside_runs.h>
#include <sinew/fill/lattice.h>
#include <sinew/fill/pack.h>

namespace sinew {

/// A surface in the coordinates of its lattice.
struct BodySpace {
  BodySpace(const Surface& given, const PackOptions& options);

  LatticeFrame placement;
  Surface surface;
  Box box;  ///< box that the lattice fills
  std::optional<Vec3> lattice_origin;
};

struct FilledSites {
  Lattice lattice;
  InsideRuns inside;      ///< empty where a layer is filled
  std::vector<Run> runs;  ///< the sites that become particles
};

/// Sites at `radius` (m); where a count is wanted, at the nearby radius that matches it best.
FilledSites fill_sites(const BodySpace& space, const PackOptions& options, double radius);

std::size_t count_of(const std::vector<Run>& runs);

/// Calls visit(place, run, n) for each site n of each run, from many threads; `place` numbers the
/// sites from 0.
template <class Visit>
void for_each_site(const std::vector<Run>& runs, const Visit& visit) {
  constexpr std::size_t runs_at_a_time = 256;
  std::vector<std::size_t> place(runs.size() + 1);
  for (std::size_t i = 0; i < runs.size(); ++i) place[i + 1] = place[i] + runs[i].sites();
  parallel_for(runs.size(), runs_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int n = runs[i].first; n < runs[i].last; ++n)
        visit(place[i] + (n - runs[i].first), runs[i], n);
  });
}

/// Positions of the runs' sites in the lattice's coordinates (n x 3, m), in their order.
Points positions_of(const Lattice& lattice, const std::vector<Run>& runs);

/// Minimal distance of a center from the surface, m.
double clearance_of(const PackOptions& options, double radius);

/// A coarse lattice over a box, for estimates.
Lattice coarse_lattice(const Box& box);

// Nearest neighbors among the filled sites: they touch at 2r. Counted on the lattice, run against
// run, without positions.

struct Touching {
  std::vector<std::int32_t> neighbors;  ///< per site of the runs, in their order: 0 to 12
  std::vector<std::int32_t> group;      ///< per run: connected sites, by their first run
  std::int32_t groups = 0;
};

/// Runs must be sorted by row and site. The same for every number of threads.
Touching touching_sites(const Lattice& lattice, const std::vector<Run>& runs);

}  // namespace sinew
