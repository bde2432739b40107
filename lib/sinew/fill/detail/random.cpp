// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/random.h>

#include <algorithm>
#include <tuple>

#include <sinew/core/fcc.h>
#include <sinew/core/particles.h>
#include <sinew/core/random.h>
#include <sinew/fill/detail/filled_space.h>
#include <sinew/fill/detail/near_surface.h>
#include <sinew/fill/detail/relax.h>

namespace sinew {
namespace {

// Radii around the body: so far particles are strewn, and so far others keep their sites and hold
// them together.
constexpr double strewn_to = 5, fixed_to = 9;
constexpr double strewn_by = 2;  // radii at most: nothing is left of the lattice

/// The sites of the body and of what is within a distance (m) of it.
std::vector<Run> runs_around(const BodySpace& space, const PackOptions& options,
                             const Lattice& lattice, double distance) {
  std::vector<Run> runs =
      runs_near(lattice, space.surface.triangles, options.thickness.value_or(0) / 2 + distance);
  if (options.thickness) return runs;
  const std::vector<Run> deep = runs_without(inside_runs(lattice, space.surface).runs, runs);
  runs.insert(runs.end(), deep.begin(), deep.end());
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
    return std::tie(a.row, a.first) < std::tie(b.row, b.first);
  });
  return runs;
}

/// The lattice, and its sites that hold the others together.
FilledSites wide_sites(const BodySpace& space, const PackOptions& options, const Lattice& lattice) {
  const double r = lattice.radius;
  const Vec3 wider = Vec3::Constant(fixed_to * r);
  FilledSites wide{lattice_in(Box(space.box.min() - wider, space.box.max() + wider), Packing::fcc,
                              r, lattice.origin),
                   {},
                   {}};
  wide.runs = runs_around(space, options, wide.lattice, fixed_to * r);
  return wide;
}

/// Strews particles among each other, by the place of each one's site alone, but none among those
/// that are fixed: it would stay there.
class Strewing {
 public:
  Strewing(const Lattice& lattice, const std::vector<Run>& runs, int seed)
      : lattice_(lattice), index_(lattice, runs), seed_(seed) {}

  bool has(const LatticePlace& site) const { return index_.run_at(site) != nullptr; }

  Vec3 place(const LatticePlace& site, const Vec3& from) const {
    Random random(seed_);
    for (const int at : site) random.mix(at);
    for (;;) {
      const Vec3 to = from + strewn_by * lattice_.radius * in_ball(random);
      if (has(nearest_fcc_site((to - lattice_.origin).cwiseQuotient(lattice_.unit)))) return to;
    }
  }

 private:
  const Lattice& lattice_;
  SiteIndex index_;
  int seed_;
};

}  // namespace

Irregular random_packing(const BodySpace& space, const PackOptions& options,
                         const FilledSites& filled) {
  const FilledSites wide = wide_sites(space, options, filled.lattice);
  const double r = wide.lattice.radius;
  const std::vector<Run> strewn = runs_around(space, options, wide.lattice, strewn_to * r);
  const Strewing strewing(wide.lattice, strewn, options.seed);
  const std::vector<LatticePlace> sites = places_of(wide);
  Points places = positions_of(wide.lattice, wide.runs);
  std::vector<char> fixed(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    fixed[i] = strewing.has(sites[i]) ? 0 : 1;
    if (fixed[i] == 0) places[i] = strewing.place(sites[i], places[i]);
  }
  relax(places, {.distance = nearest_distance(r), .fixed = fixed});

  const FilledSpace inside(space, options, r);
  Irregular packed;
  for (const Vec3& place : places) {
    const std::int32_t body = inside.body_at(place);
    if (body < 0) continue;
    packed.places.push_back(place);
    packed.body.push_back(body);
  }
  return packed;
}

}  // namespace sinew
