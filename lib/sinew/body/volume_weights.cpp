// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/body/volume_weights.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sinew/body/bond_factors.h>
#include <sinew/body/pair_pass.h>
#include <sinew/core/cell_grid.h>
#include <sinew/core/decompositions.h>

namespace sinew {
namespace {

constexpr int passes = 8;  // a pass takes what lacks one neighbor further
constexpr double largest_weight = 2;
constexpr double surrounded = 1 - 1e-6;  // where all neighbors are, but for rounding
// Highest w^2 at surfaces over that of the packing, for Poisson's ratios of 0.45 and 0.49, by power
// iteration on cubes and turned ones, where no particle takes over from others.
constexpr double surface_over_packing = 1.15;

/// The weights while they spread.
class Spreading {
 public:
  Spreading(const Points& rest, const NeighborLists& nearest, double radius,
            const std::vector<double>& volume_share)
      : near_(nearest),
        own_(own_volume_weights(rest, near_, radius)),
        weight_(own_),
        lacks_(rest.size()),
        askers_(rest.size()),
        next_(rest.size()) {
    for_each_particle(rest.size(), [&](std::size_t i) {
      const double target = volume_share.empty() ? 1 : std::min(volume_share[i], largest_weight);
      weight_[i] = std::min(own_[i], target);
      lacks_[i] = target - weight_[i];
      for (const std::uint32_t j : near_.of(i)) askers_[i] += own_[j];
    });
  }

  /// What a particle lacks goes to its neighbors, the more the better they are surrounded; whoever
  /// is inside takes it up to `most`, and what is left goes on.
  void spread(double most) {
    for_each_particle(weight_.size(), [&](std::size_t j) {
      double sum = 0;
      for (const std::uint32_t i : near_.of(j))
        if (askers_[i] > 0) sum += lacks_[i] / askers_[i];
      const double offered = own_[j] * sum;
      const double room = own_[j] < surrounded ? 0 : std::max(0.0, most - weight_[j]);
      const double taken = std::min(offered, room);
      weight_[j] += taken;
      next_[j] = offered - taken;
    });
    lacks_.swap(next_);
  }

  std::vector<double>& weights() { return weight_; }

 private:
  const NeighborLists& near_;
  std::vector<double> own_, weight_, lacks_;
  std::vector<double> askers_;  ///< sum of the own weights around each
  std::vector<double> next_;
};

}  // namespace

double volume_weight(const Mat3& A, double radius) {
  const double least = eigenvalues(A)[0];
  const double volume_share = std::clamp(least / (16 * radius * radius), 0.0, 1.0);
  return volume_share < 1e-9 ? 0 : volume_share * volume_share;
}

std::vector<double> own_volume_weights(const Points& rest, const NeighborLists& nearest,
                                       double radius) {
  std::vector<double> weights(rest.size());
  for_each_particle(rest.size(), [&](std::size_t i) {
    Mat3 A = Mat3::Zero();
    for (const std::uint32_t j : nearest.of(i))
      A += (rest[j] - rest[i]) * (rest[j] - rest[i]).transpose();
    weights[i] = volume_weight(A, radius);
  });
  return weights;
}

double max_volume_weight(const Material& material) {
  const PackingStiffness packing = material.packing();
  const double allowed = std::max(2 * stiffest_of_rough_surfaces,
                                  surface_over_packing * highest_frequency_factor(packing));
  // of 4 + s + 4 / s, as in highest_frequency_factor()
  const double s = (allowed - 4 + std::sqrt((allowed - 4) * (allowed - 4) - 16)) / 2;
  return std::clamp((s - 4 * packing.second) / (std::numbers::sqrt2 * packing.volume), 1.0,
                    largest_weight);
}

std::vector<double> volume_weights(const Points& rest, const NeighborLists& nearest,
                                   const Material& material,
                                   const std::vector<double>& volume_share) {
  Spreading spreading(rest, nearest, material.pair.r, volume_share);
  if (material.bond.second > 0)
    for (int pass = 0; pass < passes; ++pass) spreading.spread(max_volume_weight(material));
  return std::move(spreading.weights());
}

}  // namespace sinew
