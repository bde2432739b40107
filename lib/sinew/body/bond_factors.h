// SPDX-License-Identifier: GPL-3.0-or-later
// Stiffness of the bonds near a surface. Particles there have fewer than 18 bonds, so a body would
// be softer than its material, the more so the thinner it is. Each of them asks for factors on its
// bonds, as near to 1 as may be (least squares), with which they are as stiff in every direction as
// all 18 are, times the particle's volume share: the sum of k l^2 n n n n over its bonds is
// that of the isotropic packing. A bond has the mean of what its two particles ask for.
//
//     body.factors = bond_factors(body.rest, *neighbors_of(body), body.material,
//     body.volume_share); const double factor = body.factors.of(id).at(neighbor);
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/core/rest_neighbors.h>
#include <sinew/material/material.h>

namespace sinew {

/// BondFactors::stiffest of surfaces in any direction of the packing.
inline constexpr double stiffest_of_rough_surfaces = 7.2;

/// Factors on the bonds of those particles alone that have others than 1.
struct BondFactors {
  std::vector<std::uint32_t> particle;  ///< ids, ascending
  std::vector<std::uint32_t> first;     ///< first bond of each particle
  std::vector<std::uint32_t> neighbor;  ///< one per bond, an id
  std::vector<double> factor;           ///< one per bond
  /// Weight of each particle's volume (volume_weights.h), by id; empty: volume_weight() of its
  /// neighbors, where volumes are kept.
  std::vector<double> volume_weight;
  /// No sum of the bonds' n n^T around a particle, times their factors and stiffness over k, has a
  /// larger eigenvalue; 4 and a half inside. Where volumes are kept, nor has any mode more than
  /// twice this as w^2, in k / m.
  double stiffest = 4.5;

  /// The bonds of one particle.
  struct Row {
    std::span<const std::uint32_t> neighbor;
    std::span<const double> factor;

    bool empty() const { return neighbor.empty(); }
    /// Returns the factor of the bond with particle `id`.
    double at(std::uint32_t id) const;
  };
  /// Empty where all factors are 1.
  Row of(std::uint32_t id) const;
};

/// Finds the factors of particles at `rest` (m) with the neighbors `near`. `volume_share`: the
/// volume of the body around each particle over that of one inside; `stiffness`: that of the
/// material there over the body's, of which a bond has the harmonic mean, as springs in series;
/// empty: 1 each. `volume`: K_v there, Pa; empty: the material's. In parallel, the same for any
/// number of threads. None without bonds of second neighbors, but for the weights of volumes that
/// are kept.
BondFactors bond_factors(const Points& rest, const RestNeighbors& near, const Material& material,
                         const std::vector<double>& volume_share,
                         const std::vector<double>& stiffness = {},
                         const std::vector<double>& volume = {});

}  // namespace sinew
