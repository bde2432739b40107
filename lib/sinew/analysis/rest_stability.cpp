// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/rest_stability.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <sinew/body/solid.h>
#include <sinew/core/particles.h>

namespace sinew {
namespace {

constexpr double cluster_radius = 5;  // in r: 80 to 90 particles
constexpr std::array<double, 3> strains = {1e-3, 3e-3, 1e-2};
constexpr int trials = 100;             // per strain: one in eight or so finds what is wrong
constexpr double rounding_rise = 1e-3;  // rounding makes 1e-7 of it, stable packings some tenths

/// Sites of layers A B C (FCC) or A B A (HCP) within the ball, m.
Points cluster(Packing packing, double r) {
  constexpr int n = static_cast<int>(cluster_radius) + 2;
  const double row = std::sqrt(3.0) * r, layer = std::sqrt(8.0 / 3) * r;
  Points sites;
  for (int k = -n; k <= n; ++k)
    for (int j = -n; j <= n; ++j)
      for (int i = -n; i <= n; ++i) {
        const int shift = packing == Packing::hcp ? k & 1 : ((k % 3) + 3) % 3;
        const Vec3 site(2 * r * i + r * (j & 1) + r * shift, row * j + row / 3 * shift, layer * k);
        if (site.norm() < cluster_radius * r) sites.push_back(site);
      }
  return sites;
}

/// Three numbers between -1 and 1, the same on every machine.
Vec3 random_vector(std::mt19937_64& random) {
  const auto number = [&] { return 0x1p-52 * static_cast<double>(random() >> 11) - 1; };
  const double x = number(), y = number(), z = number();
  return {x, y, z};
}

/// Symmetric, of Frobenius norm 1.
Mat3 random_strain(std::mt19937_64& random) {
  Mat3 strain;
  strain.col(0) = random_vector(random);
  strain.col(1) = random_vector(random);
  strain.col(2) = random_vector(random);
  const Mat3 symmetric = (strain + strain.transpose()) / 2;
  return symmetric / symmetric.norm();
}

Points strained(const Points& rest, double strain, std::mt19937_64& random) {
  const Mat3 F = Mat3::Identity() + strain * random_strain(random);
  Points moved;
  for (const Vec3& site : rest) moved.push_back(F * site);
  return moved;
}

Points shaken(const Points& rest, double distance, std::mt19937_64& random) {
  Points moved;
  for (const Vec3& site : rest) moved.push_back(site + distance * random_vector(random));
  return moved;
}

/// The energy that particles of the material have at any places, J.
std::function<double(const Points&)> energy_of(const Material& material, const Points& rest) {
  const double r = material.pair.r;
  if (!remembers_neighbors(material))
    return [=](const Points& at) {
      return pair_energy(particles_at(at, r, material.mass), material.pair);
    };
  return [=, solid = Solid(material, rest)](const Points& at) mutable {
    return solid.energy(particles_at(at, r, material.mass));
  };
}

}  // namespace

double min_rise(const Material& material, Packing packing) {
  const double r = material.pair.r;
  const Points rest = cluster(packing, r);
  const auto energy = energy_of(material, rest);
  const double at_rest = energy(rest);
  std::mt19937_64 random(5);  // any seed: the check must give the same result each time
  double least = std::numeric_limits<double>::infinity();
  for (const double strain : strains) {
    const double amplitude = strain * r;
    const double unit =
        static_cast<double>(rest.size()) * material.stiffness() * amplitude * amplitude / 2;
    for (int trial = 0; trial < trials; ++trial)
      for (const Points& moved : {strained(rest, strain, random), shaken(rest, amplitude, random)})
        least = std::min(least, (energy(moved) - at_rest) / unit);
  }
  return least;
}

bool rests_stably(const Material& material) {
  return min_rise(material, Packing::fcc) > rounding_rise &&
         min_rise(material, Packing::hcp) > rounding_rise;
}

}  // namespace sinew
