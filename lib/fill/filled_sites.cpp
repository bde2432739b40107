// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/filled_sites.h"

#include <algorithm>
#include <cmath>

#include "fill/near/near_surface.h"
#include "fill/runs.h"
#include "fill/volume_inside.h"

namespace sinew {
namespace {

constexpr double coarse_sites = 50000;
constexpr double well_met = 0.02;  // a count, relative
constexpr int most_rounds = 6;
constexpr double most_shrink = 3;  // more would be many times the sites that were asked for

FilledSites fill_at(const BodySpace& space, const PackOptions& options, double radius) {
  FilledSites filled{lattice_in(space.box, options.packing, radius, space.lattice_origin), {}, {}};
  if (options.thickness) {
    filled.runs = runs_near(filled.lattice, space.surface.triangles, *options.thickness / 2);
    return filled;
  }
  filled.inside = inside_runs(filled.lattice, space.surface);
  filled.runs = filled.inside.runs;
  const double within = clearance_of(options, radius);
  if (within >= space.box.sizes().minCoeff() / 2)
    filled.runs.clear();  // no place is so deep
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
  box = bounds(surface.triangles.points);
  if (options.lattice_origin) lattice_origin = placement.to_lattice(*options.lattice_origin);
  const Vec3 margin = Vec3::Constant(options.thickness.value_or(0) / 2);
  box = Box(box.min() - margin, box.max() + margin);
}

FilledSites fill_sites(const BodySpace& space, const PackOptions& options, double radius) {
  FilledSites best = fill_at(space, options, radius);
  if (!options.count || best.runs.empty()) return best;
  const auto share = [&](const FilledSites& filled) {  // of the wanted count
    return static_cast<double>(count_of(filled.runs)) / *options.count;
  };
  const auto miss = [&](const FilledSites& filled) { return std::abs(std::log(share(filled))); };
  double next = best.lattice.radius * std::cbrt(share(best));
  for (int round = 0; round < most_rounds && miss(best) > well_met; ++round) {
    FilledSites found = fill_at(space, options, std::max(next, radius / most_shrink));
    if (found.runs.empty()) break;
    next = found.lattice.radius * std::cbrt(share(found));
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

}  // namespace sinew
