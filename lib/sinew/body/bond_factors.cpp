// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/body/bond_factors.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include <sinew/body/volume_weights.h>
#include <sinew/core/decompositions.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/material/local_strength.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_search = 1024;
constexpr std::size_t bonds_inside = 18;
constexpr double min_factor = 0.1, max_factor = 4;
constexpr double max_volume_share = 2;
constexpr double min_difference = 1e-3;  // difference of a volume share from that inside
// Regularization of the least squares: hardly any in a lattice. Elsewhere exact solutions ask for
// bonds that push apart, and a body with factors this near to 1 is stiffer.
constexpr double regularization = 1e-6 / 18, irregular_regularization = 3e-2 / 18;
// w^2 of modes at edges over that of waves through the largest weight, by power iteration on cubes
// and turned ones, for Poisson's ratios up to 0.49.
constexpr double edges_over_waves = 1.02;
constexpr double min_offset = 1e-3;  // in radii, of a neighbor's distance from a lattice's

/// The independent components of a symmetric tensor of fourth order, so that sums of products are
/// those of the tensors.
using Tensor = Eigen::Matrix<double, 15, 1>;
using Tensors = Eigen::Matrix<double, 15, Eigen::Dynamic>;

Tensor fourth_power(const Vec3& n) {
  static constexpr std::array<double, 5> factorial = {1, 1, 2, 6, 24};
  Tensor components;
  int at = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      for (int k = j; k < 3; ++k)
        for (int l = k; l < 3; ++l) {
          std::array<int, 3> times{};
          for (const int axis : {i, j, k, l}) ++times[axis];
          double orders = 24;
          for (const int count : times) orders /= factorial[count];
          components[at++] = std::sqrt(orders) * n[i] * n[j] * n[k] * n[l];
        }
  return components;
}

/// The sum of k l^2 n n n n inside, over k d0^2.
Tensor inside() {
  Tensor sum = Tensor::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 one = Vec3::Unit(axis), other = Vec3::Unit((axis + 1) % 3);
    for (const double sign : {1.0, -1.0})
      sum += 2 * fourth_power((one + sign * other).normalized());
    sum += isotropic_second * 2 * 2 * fourth_power(one);
  }
  return sum;
}

/// Bonds of the particles, and what those at the surface ask for.
class SurfaceBonds {
 public:
  SurfaceBonds(const Points& rest, const RestNeighbors& near, const Material& material,
               const std::vector<double>& volume_share, const std::vector<double>& stiffness)
      : rest_(rest),
        volume_share_(volume_share),
        stiffness_(stiffness),
        r_(material.pair.r),
        second_(material.packing().second),
        near_(near.all()) {}

  BondFactors factors() {
    find_asking();
    find_asked();
    BondFactors out;
    out.first.push_back(0);
    for (std::size_t i = 0; i < rest_.size(); ++i) {
      if (!is_touched(i)) continue;
      out.particle.push_back(static_cast<std::uint32_t>(i));
      out.first.push_back(out.first.back() + static_cast<std::uint32_t>(bonds_of(i)));
    }
    out.neighbor.resize(out.first.back());
    out.factor.resize(out.first.back());
    std::vector<double> stiffest(out.particle.size());
    parallel_for(out.particle.size(), particles_per_search,
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t n = begin; n < end; ++n)
                     stiffest[n] = put(out.particle[n], out.neighbor.data() + out.first[n],
                                       out.factor.data() + out.first[n]);
                 });
    for (const double one : stiffest) out.stiffest = std::max(out.stiffest, one);
    return out;
  }

 private:
  /// Why a particle asks for factors.
  enum Reason : char { nothing, at_edge, irregular };

  template <class Visit>
  void for_each(const Visit& visit) const {
    parallel_for(rest_.size(), particles_per_search, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) visit(i);
    });
  }

  std::size_t bonds_of(std::size_t i) const { return near_.of(i).size(); }
  /// Whether particle i has other distances to its neighbors than in a lattice.
  bool is_irregular(std::size_t i) const {
    const auto around = near_.of(i);
    return std::any_of(around.begin(), around.end(), [&](std::uint32_t j) {
      const double d = (rest_[j] - rest_[i]).norm();
      return std::min(std::abs(d - nearest_distance(r_)), std::abs(d - second_distance(r_))) >
             min_offset * r_;
    });
  }
  bool asks(std::size_t i) const { return asks_[i] != nothing; }
  void find_asking() {
    asks_.resize(rest_.size());
    for_each([&](std::size_t i) {
      const bool other_volume_share =
          !volume_share_.empty() && std::abs(volume_share_[i] - 1) > min_difference;
      asks_[i] = is_irregular(i)                                    ? irregular
                 : bonds_of(i) < bonds_inside || other_volume_share ? at_edge
                                                                    : nothing;
    });
  }
  bool is_touched(std::size_t i) const {
    const auto around = near_.of(i);
    return is_special(i) || std::any_of(around.begin(), around.end(),
                                        [&](std::uint32_t j) { return is_special(j); });
  }
  bool is_special(std::size_t i) const {
    return asks(i) || (!stiffness_.empty() && stiffness_[i] != 1);
  }
  /// Returns the stiffness of the material between two particles.
  double stiffness_between(std::size_t i, std::size_t j) const {
    if (stiffness_.empty()) return 1;
    return 2 / (1 / stiffness_[i] + 1 / stiffness_[j]);
  }
  double relative_stiffness(double length) const {
    return length < rest_neighbor_range(r_) ? 1 : second_;
  }

  void find_asked() {
    first_.assign(rest_.size() + 1, 0);
    for (std::size_t i = 0; i < rest_.size(); ++i)
      first_[i + 1] = first_[i] + (asks(i) ? static_cast<std::uint32_t>(bonds_of(i)) : 0);
    asked_.resize(first_.back());
    for_each([&](std::size_t i) {
      if (asks(i) && bonds_of(i) > 0) ask(i);
    });
  }

  void ask(std::size_t i) {
    static const Tensor whole = inside();
    const auto around = near_.of(i);
    Tensors tensors(15, around.size());
    for (std::size_t b = 0; b < around.size(); ++b) {
      const Vec3 X = rest_[around[b]] - rest_[i];
      const double length = X.norm(), relative = length / nearest_distance(r_);
      tensors.col(static_cast<Eigen::Index>(b)) =
          relative_stiffness(length) * relative * relative * fourth_power(X / length);
    }
    const double volume_share =
        volume_share_.empty() ? 1 : std::min(volume_share_[i], max_volume_share);
    const Eigen::Matrix<double, 15, 15> normal =
        tensors * tensors.transpose() +
        (asks_[i] == irregular ? irregular_regularization : regularization) * whole.squaredNorm() *
            Eigen::Matrix<double, 15, 15>::Identity();
    const Tensor lacking = volume_share * whole - tensors.rowwise().sum();
    const Eigen::VectorXd change = tensors.transpose() * normal.ldlt().solve(lacking);
    for (std::size_t b = 0; b < around.size(); ++b)
      asked_[first_[i] + b] = 1 + change[static_cast<Eigen::Index>(b)];
  }

  /// What particle i asks for its bond with j.
  double asked(std::size_t i, std::uint32_t j) const {
    if (!asks(i)) return 1;
    const auto around = near_.of(i);
    const auto at = std::find(around.begin(), around.end(), j) - around.begin();
    return asked_[first_[i] + static_cast<std::size_t>(at)];
  }

  /// The factors of a particle's bonds; returns the largest eigenvalue of their sum.
  double put(std::size_t i, std::uint32_t* neighbor, double* factor) const {
    Mat3 sum = Mat3::Zero();
    for (const std::uint32_t j : near_.of(i)) {
      const double mean = (asked(i, j) + asked(j, static_cast<std::uint32_t>(i))) / 2;
      *neighbor++ = j;
      *factor = std::clamp(mean, min_factor, max_factor) * stiffness_between(i, j);
      const Vec3 X = rest_[j] - rest_[i];
      sum += *factor++ * relative_stiffness(X.norm()) / X.squaredNorm() * X * X.transpose();
    }
    return eigenvalues(sum)[2];
  }

  const Points& rest_;
  const std::vector<double>&volume_share_, &stiffness_;
  double r_, second_;
  const NeighborLists& near_;
  std::vector<Reason> asks_;
  std::vector<std::uint32_t> first_;  ///< first of each particle in asked_
  std::vector<double> asked_;         ///< values of the particles that ask
};

/// With the largest K_v, over its bonds, of any particle.
Material with_max_volume_stiffness(Material material, const std::vector<double>& stiffness,
                                   const std::vector<double>& volume) {
  for (std::size_t i = 0; i < volume.size(); ++i)
    material.volume_stiffness =
        std::max(material.volume_stiffness, volume[i] / value_at(stiffness, i, 1));
  return material;
}

}  // namespace

double BondFactors::Row::at(std::uint32_t id) const {
  const auto found = std::find(neighbor.begin(), neighbor.end(), id);
  return found == neighbor.end() ? 1 : factor[static_cast<std::size_t>(found - neighbor.begin())];
}

BondFactors::Row BondFactors::of(std::uint32_t id) const {
  const auto found = std::lower_bound(particle.begin(), particle.end(), id);
  if (found == particle.end() || *found != id) return {};
  const auto n = static_cast<std::size_t>(found - particle.begin());
  const std::size_t bonds = first[n + 1] - first[n];
  return {{neighbor.data() + first[n], bonds}, {factor.data() + first[n], bonds}};
}

BondFactors bond_factors(const Points& rest, const RestNeighbors& near, const Material& material,
                         const std::vector<double>& volume_share,
                         const std::vector<double>& stiffness, const std::vector<double>& volume) {
  BondFactors factors;
  if (material.bond.second > 0)
    factors = SurfaceBonds(rest, near, material, volume_share, stiffness).factors();
  const Material keeping = with_max_volume_stiffness(material, stiffness, volume);
  if (keeping.volume_stiffness <= 0) return factors;
  factors.volume_weight = volume_weights(rest, near.nearest, keeping, volume_share);
  const double most = *std::max_element(factors.volume_weight.begin(), factors.volume_weight.end());
  PackingStiffness packing = keeping.packing();
  packing.volume *= most;
  factors.stiffest = std::max(factors.stiffest, largest_of(stiffness, 1) * edges_over_waves *
                                                    highest_frequency_factor(packing) / 2);
  return factors;
}

}  // namespace sinew
