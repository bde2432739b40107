// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/rest_stability.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <sinew/core/vector.h>

namespace sinew {
namespace {

/// Sites of the body-centered tetragonal lattice around one at the origin, in edges: FCC where
/// c/a is sqrt(2).
std::vector<Vec3> sites_around() {
  constexpr int reach = 2;
  std::vector<Vec3> sites;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      for (int k = -reach; k <= reach; ++k)
        for (const double half : {0.0, 0.5})
          if (i != 0 || j != 0 || k != 0 || half != 0)
            sites.emplace_back(i + half, j + half, k + half);
  return sites;
}

/// Returns the energy of a particle, J; `a` is the shorter edge at the beginning, m.
double energy_of(const PairForce& pair, const std::vector<Vec3>& sites, double a, double ratio) {
  double sum = 0;
  for (const Vec3& site : sites)
    sum += pair.potential(a * Vec3(site.x(), site.y(), ratio * site.z()).norm());
  return sum / 2;
}

/// Searches the least over `a`, first in steps and then between them.
double min_energy(const PairForce& pair, const std::vector<Vec3>& sites, double ratio) {
  constexpr int scans = 100, halvings = 40;
  const double low = 1.7 * pair.r, step = 0.9 * pair.r / scans;
  double best = low, least = std::numeric_limits<double>::infinity();
  for (int n = 0; n <= scans; ++n)
    if (const double one = energy_of(pair, sites, low + n * step, ratio); one < least)
      least = one, best = low + n * step;
  for (double width = step / 2; width > step * std::pow(0.5, halvings); width /= 2)
    for (const double at : {best - width, best + width})
      if (const double one = energy_of(pair, sites, at, ratio); one < least) least = one, best = at;
  return least;
}

}  // namespace

double BainPath::barrier() const { return *std::max_element(energy.begin(), energy.end()); }

BainPath bain_path(const PairForce& pair, int steps) {
  const std::vector<Vec3> sites = sites_around();
  const double unit = pair.contact_stiffness() * pair.r * pair.r;
  BainPath path;
  double at_fcc = 0;
  for (int n = 0; n <= steps; ++n) {
    const double ratio = std::numbers::sqrt2 + (1 - std::numbers::sqrt2) * n / steps;
    const double energy = min_energy(pair, sites, ratio);
    if (n == 0) at_fcc = energy;
    path.energy.push_back((energy - at_fcc) / unit);
  }
  return path;
}

}  // namespace sinew
