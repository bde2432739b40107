// SPDX-License-Identifier: GPL-3.0-or-later
// Elastic constants of a closest packing whose bonds of length d0 have the stiffness k, and of one
// that resists changes of volume besides. Everything is in units of k / d0 unless said otherwise.
#pragma once

#include <numbers>

#include <sinew/core/vector.h>

namespace sinew {

/// Of a cubic crystal, FCC, in any one unit of stress.
struct CubicConstants {
  double C11, C12, C44;

  double bulk_modulus() const { return (C11 + 2 * C12) / 3; }
  /// Voigt-Reuss-Hill means over all directions.
  double hill_shear_modulus() const;
  double hill_young_modulus() const;
  double hill_poisson_ratio() const;
  /// Along `direction` (any length but 0), in the crystal's axes.
  double young_modulus(const Vec3& direction) const;
  /// Mean of the contractions across `direction` over its stretch.
  double poisson_ratio(const Vec3& direction) const;
};

/// Central bonds alone, and with a stiffness K_v against changes of volume.
constexpr CubicConstants fcc_constants(double volume_stiffness = 0) {
  constexpr double shear = 1 / std::numbers::sqrt2;
  return {2 * shear + volume_stiffness, shear + volume_stiffness, shear};
}

/// Hill means of central bonds; HCP's differ by less than 1 %.
inline constexpr double hill_young = 1.3505, hill_shear = 0.5354, hill_poisson = 0.261,
                        bulk_of_bonds = 2 * std::numbers::sqrt2 / 3;

/// The stiffness against changes of volume that gives a Poisson's ratio (Hill): 0 at the bonds'
/// own, 0.261; more is not to be had by less.
double volume_stiffness_for(double poisson_ratio);

/// The share of its bending stiffness, E I of the shape filled, that a body lacks for being only
/// `planes` half-planes of particles across: springs end at the outermost particles, not at the
/// surface. Measured on square FCC beams of 5 to 17 planes, within 0.03; at most 1.
double lack_of_bending_stiffness(double planes);

/// How much the highest frequency of the lattice rises: w^2 = this k / m (8 for bonds alone).
double highest_frequency_factor(double volume_stiffness);

}  // namespace sinew
