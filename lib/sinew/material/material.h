// SPDX-License-Identifier: GPL-3.0-or-later
// Turns engineering values (Young's modulus, density, damping) into the constants of the particles,
// for closest-packed bodies with bonds of stiffness k at distance d0 = 2r.
//
//     const Material material = make_material(options, {radius, mass});
#pragma once

#include <array>

#include <sinew/core/options.h>
#include <sinew/material/elasticity.h>
#include <sinew/material/pair_force.h>

namespace sinew {

/// A spring and a dashpot in series beside each bond (see maxwell.h).
struct MaxwellBranch {
  double modulus_ratio = 0;  ///< g, of the bond's stiffness; 0: none
  double time = 0;           ///< tau, s
};

/// Strength of the bonds of a solid. Strains are changes of a bond's length over its rest length.
struct BondStrength {
  double stiffness = 0;        ///< stiffness of bonds to nearest neighbors, N/m
  double second = 0;           ///< the same to second neighbors, N/m; 0: those have no bonds
  double breaking_strain = 0;  ///< in tension; 0: never breaks
  /// Shear sqrt(D : D) around a particle beyond which its bonds creep (see solid.h); 0: never.
  double yield_shear = 0;
  double creep_rate = 0;  ///< rate of what exceeds it, 1/s
  std::array<MaxwellBranch, max_relaxation_branches> branches = {};  ///< branches in use come first

  std::size_t branch_count() const;
  double long_term() const;  ///< stiffness that does not relax, over all of it
};

struct ForceLaw;

struct Material {
  MaterialModel model = MaterialModel::paper;
  Cohesion cohesion = Cohesion::all;
  PairForce pair;
  BondStrength bond;
  double volume_stiffness = 0;  ///< K_v, Pa
  double relaxed = 1;           ///< factor on the bonds, where their branches are relaxed for good
  double order = 1;             ///< moduli of the bonds over those in FCC: less in random packings
  double mass = 0;              ///< mass of a particle, kg
  double damping = 0;           ///< C of eq. 2, kg/s
  DampingForm damping_form = DampingForm::paper;
  const ForceLaw* law = nullptr;  ///< in place of the model's (laws.h); a program keeps it alive
  double friction = 0;            ///< coefficient, between particles that touch and are not bonded

  double young_modulus() const;  ///< Pa, Hill average over directions
  double stiffness() const;      ///< the stiffest of contact, tension and bonds, N/m
  PackingStiffness packing() const;
  /// Returns those of the packing, in its own axes, Pa.
  CubicConstants constants() const;
};

/// How a body is filled.
struct PackedBody {
  double radius = 0;                ///< radius of a particle, m
  double mass = 0;                  ///< mass of a particle, kg
  Mat3 lattice = Mat3::Identity();  ///< columns: the packing's axes
  Packing packing = Packing::fcc;
};

/// The constants for the particles of a body. A damping ratio is left to elastic_modes.h: it
/// depends on the body's shape.
Material make_material(const MaterialOptions& settings, const PackedBody& body);

/// The shear sqrt(D : D), D the deviator of the strain, of a bar pulled to its yield strain.
double yield_shear(double yield_strain, double poisson_ratio);
/// Returns Poisson's ratio in the options: of bonds alone where no volume is kept.
double poisson_ratio_of(const MaterialOptions& settings);
/// K_v of bonds `relative` times as stiff as the material's are at once, Pa.
double local_volume_stiffness(const Material& material, double relative, double poisson_ratio);

/// The material once its branches have relaxed, without them.
Material long_term(Material material);

/// Throws bad input unless a body of the one material may go on as one of the other: constants that
/// are finite and not negative, and the same model, particles and kinds of bonds.
void check_variant(const Material& now, const Material& next);

}  // namespace sinew
