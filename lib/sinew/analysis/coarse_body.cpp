// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/elastic_modes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <sinew/core/fcc.h>
#include <sinew/core/particles.h>

namespace sinew {
namespace {

constexpr double min_volume_share = 0.4;  // share of a site that is kept
constexpr std::size_t min_neighbors = 6;  // half of those inside

using SiteValues = std::map<FccSite, double>;

/// The same in particles `larger` times as large. Stresses keep their constants, springs grow with
/// the length.
Material enlarged(Material material, double larger) {
  for (double* length : {&material.pair.r, &material.pair.a, &material.pair.b}) *length *= larger;
  for (double* spring : {&material.bond.stiffness, &material.bond.second}) *spring *= larger;
  material.mass *= larger * larger * larger;
  material.damping *= larger * larger;
  return material;
}

std::vector<FccSite> nearest_steps() {
  std::vector<FccSite> steps = fcc_steps(2);
  std::erase_if(steps, [](const FccSite& step) {
    return step[0] * step[0] + step[1] * step[1] + step[2] * step[2] != 2;
  });
  return steps;
}

/// Calls visit(iterator) for the nearest neighbors of a site that are there.
template <class Visit>
void for_each_around(SiteValues& volume_shares, const FccSite& site, const Visit& visit) {
  static const std::vector<FccSite> steps = nearest_steps();
  for (const FccSite& step : steps) {
    const auto found =
        volume_shares.find({site[0] + step[0], site[1] + step[1], site[2] + step[2]});
    if (found != volume_shares.end()) visit(found);
  }
}

/// Sites with little of the body, or with few bonds, leave it to the neighbor that has most.
SiteValues kept(SiteValues volume_shares) {
  for (bool changed = true; changed;) {
    changed = false;
    for (auto at = volume_shares.begin(); at != volume_shares.end();) {
      std::size_t bonds = 0;
      auto most = volume_shares.end();
      for_each_around(volume_shares, at->first, [&](SiteValues::iterator other) {
        ++bonds;
        if (most == volume_shares.end() || other->second > most->second) most = other;
      });
      if ((at->second >= min_volume_share && bonds >= min_neighbors) ||
          most == volume_shares.end()) {
        ++at;
        continue;
      }
      most->second += at->second;
      at = volume_shares.erase(at);
      changed = true;
    }
  }
  for (auto& [site, volume_share] : volume_shares) {
    std::size_t bonds = 0;
    for_each_around(volume_shares, site, [&](SiteValues::iterator) { ++bonds; });
    if (bonds == nearest_steps().size()) volume_share = 1;
  }
  return volume_shares;
}

/// The particle nearest to the middle: its site is one of the coarse packing too, which therefore
/// meets the body's faces as its own does.
Vec3 middle_of(const Points& rest) {
  Vec3 center = Vec3::Zero();
  for (const Vec3& place : rest) center += place / static_cast<double>(rest.size());
  return *std::min_element(rest.begin(), rest.end(), [&](const Vec3& a, const Vec3& b) {
    return (a - center).squaredNorm() < (b - center).squaredNorm();
  });
}

}  // namespace

Body coarse_body(const Body& body, int times) {
  const double larger = times;
  const double unit = std::numbers::sqrt2 * larger * body.material.pair.r;
  const Vec3 center = middle_of(body.rest);
  // A particle is spread over its own volume, lest cells hold now two, now four.
  SiteValues all, stiffness, volume, density;
  const std::vector<FccSite> parts = nearest_steps();
  for (std::size_t i = 0; i < body.rest.size(); ++i) {
    const Vec3 at = body.lattice.transpose() * (body.rest[i] - center) / unit;
    const double volume_share = (body.volume_share.empty() ? 1 : body.volume_share[i]) /
                                (larger * larger * larger) / static_cast<double>(parts.size());
    for (const FccSite& part : parts) {
      const FccSite site = nearest_fcc_site(at + 0.5 / larger * Vec3(part[0], part[1], part[2]));
      all[site] += volume_share;
      if (!body.stiffness.empty()) stiffness[site] += volume_share * body.stiffness[i];
      if (!body.density.empty()) density[site] += volume_share * body.density[i];
      if (!body.local.volume.empty()) volume[site] += volume_share * body.local.volume[i];
    }
  }
  for (SiteValues* sums : {&stiffness, &volume, &density})
    for (auto& [site, sum] : *sums) sum /= all[site];
  Body coarse;
  coarse.lattice = body.lattice;
  coarse.material = enlarged(body.material, larger);
  for (const auto& [site, volume_share] : kept(std::move(all))) {
    coarse.rest.emplace_back(center + unit * (body.lattice * Vec3(site[0], site[1], site[2])));
    coarse.volume_share.push_back(volume_share);
    if (!stiffness.empty()) coarse.stiffness.push_back(stiffness[site]);
    if (!density.empty()) coarse.density.push_back(density[site]);
    if (!volume.empty()) coarse.local.volume.push_back(volume[site]);
  }
  coarse.material.mass = body.material.mass * static_cast<double>(body.rest.size()) /
                         static_cast<double>(coarse.rest.size());
  coarse.neighbors = neighbors_of(coarse);
  coarse.factors = bond_factors(coarse.rest, *coarse.neighbors, coarse.material,
                                coarse.volume_share, coarse.stiffness, coarse.local.volume);
  return coarse;
}

}  // namespace sinew
