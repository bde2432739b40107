// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/owners.h>

#include <cmath>
#include <utility>

#include <sinew/core/fcc.h>

namespace sinew {
namespace {

constexpr std::int32_t neighbors_inside = 12;
constexpr int reach = 3;         // units within which a point belongs to a particle
constexpr double nearby = 1.42;  // inside a packing a particle is this near nearly everywhere

}  // namespace

SiteOwners::SiteOwners(const FilledSites& filled, const Touching& touching)
    : filled_(filled),
      touching_(touching),
      index_(filled.lattice, filled.runs),
      places_(places_of(filled)) {}

Vec3 SiteOwners::place(std::size_t particle) const {
  const LatticePlace& place = places_[particle];
  return {double(place[0]), double(place[1]), double(place[2])};
}

std::int64_t SiteOwners::nearest(const Vec3& at) const {
  static const std::vector<FccSite> around = fcc_steps(reach);
  const LatticePlace nearest = nearest_fcc_site(at);
  if (const std::int64_t own = index_.at(nearest); own >= 0) return own;
  std::int64_t best = -1;
  double least = HUGE_VAL;
  for (const LatticePlace& step : around) {
    const LatticePlace place = {nearest[0] + step[0], nearest[1] + step[1], nearest[2] + step[2]};
    const double squared = (Vec3(place[0], place[1], place[2]) - at).squaredNorm();
    if (squared >= least) continue;
    const std::int64_t site = index_.at(place);
    if (site >= 0) best = site, least = squared;
  }
  return best;
}

bool SiteOwners::surrounded(std::size_t particle) const {
  return touching_.neighbors[particle] == neighbors_inside;
}

void SiteOwners::for_each_touching(std::size_t particle,
                                   const std::function<void(std::size_t)>& visit) const {
  const LatticePlace& place = places_[particle];
  for (const LatticePlace& step : filled_.lattice.nearest(place[2])) {
    const std::int64_t j = index_.at({place[0] + step[0], place[1] + step[1], place[2] + step[2]});
    if (j >= 0) visit(static_cast<std::size_t>(j));
  }
}

PointOwners::PointOwners(Points places, const NeighborLists& touching)
    : places_(std::move(places)),
      touching_(touching),
      near_(places_, nearby),
      far_(places_, reach) {}

std::int64_t PointOwners::nearest(const Vec3& at) const {
  std::int64_t best = -1;
  double least = HUGE_VAL;
  const auto visit = [&](std::uint32_t j) {
    const double squared = (places_[j] - at).squaredNorm();
    if (squared < least || (squared == least && j < best)) best = j, least = squared;
  };
  near_.for_each_near(at, visit);
  if (least > nearby * nearby) far_.for_each_near(at, visit);
  return least <= reach * reach ? best : -1;
}

void PointOwners::for_each_touching(std::size_t particle,
                                    const std::function<void(std::size_t)>& visit) const {
  for (const std::uint32_t j : touching_.of(particle)) visit(j);
}

}  // namespace sinew
