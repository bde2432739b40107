// SPDX-License-Identifier: GPL-3.0-or-later
// Elastic constants of a closest packing with bonds of length d0 and stiffness k, and of one that
// also resists changes of volume. Everything is in units of k / d0 unless stated otherwise.
//
//     const double E = fcc_constants().young_modulus(Vec3::UnitX());
//     const double K_v = volume_stiffness_for(0.4);
#pragma once

#include <numbers>

#include <sinew/core/vector.h>

namespace sinew {

/// Elastic constants of a cubic (FCC) crystal, in any unit of stress.
struct CubicConstants {
  double C11, C12, C44;

  double bulk_modulus() const { return (C11 + 2 * C12) / 3; }
  /// Voigt-Reuss-Hill means over all directions.
  double hill_shear_modulus() const;
  double hill_young_modulus() const;
  double hill_poisson_ratio() const;
  /// Along `direction` (any length but 0), in the crystal's axes.
  double young_modulus(const Vec3& direction) const;
  /// Mean contraction across `direction` over the stretch along it.
  double poisson_ratio(const Vec3& direction) const;
};

/// What a packing resists with: bonds of stiffness k to the twelve nearest neighbors, and, in units
/// of that, bonds to the six second ones, and a stiffness K_v against changes of volume.
struct PackingStiffness {
  double second = 0;  ///< stiffness of a bond, over k
  double volume = 0;  ///< K_v, in k / d0
};

constexpr CubicConstants fcc_constants(const PackingStiffness& of = {}) {
  constexpr double shear = 1 / std::numbers::sqrt2;
  return {2 * shear + 4 * shear * of.second + of.volume, shear + of.volume, shear};
}

/// With a quarter of the stiffness, second neighbors make the FCC packing isotropic: C11 - C12 = 2
/// C44, E = 2.5 k / (sqrt(2) d0), Poisson's ratio 1/4.
inline constexpr double isotropic_second = 0.25, isotropic_poisson = 0.25;

/// Young's modulus of a random packing over that of the isotropic FCC with the same bonds, factors
/// included: its particles give way to each other. Measured on periodic packings of 864 and 2,048
/// particles with bonds up to 3.1 r.
inline constexpr double random_young = 0.945;

/// Hill means of central bonds; HCP's differ by less than 1 %.
inline constexpr double hill_young = 1.3505, hill_shear = 0.5354, hill_poisson = 0.261,
                        bulk_of_bonds = 2 * std::numbers::sqrt2 / 3;

/// The stiffness against changes of volume that gives a Poisson's ratio (Hill): 0 at 0.261, or at
/// 1/4 with second neighbors, that of the bonds alone; lower ratios cannot be reached.
double volume_stiffness_for(double poisson_ratio, double second = 0);

/// The fraction of its bending stiffness (E I of the filled shape) that a body lacks because it is
/// only `planes` half-planes of particles across: springs end at the outermost particles, not at
/// the surface. Measured on square FCC bars of 5 to 17 planes: to 0.03 along [100]; of isotropic
/// bonds, whose surfaces make up for most of it, the most of any direction. At most 1.
double lack_of_bending_stiffness(double planes, bool isotropic = false);

/// Factor of the highest lattice frequency: w^2 = this k / m (8 for twelve bonds alone, 9 for
/// isotropic ones).
double highest_frequency_factor(const PackingStiffness& of);

}  // namespace sinew
