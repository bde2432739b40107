// SPDX-License-Identifier: GPL-3.0-or-later
// From engineering values (Young's modulus, density, damping) to the constants of the particles,
// for closest-packed bodies with bonds of stiffness k at distance d0 = 2r.
//
//     const Material material = make_material(options, shape_of(rest, radius, mass));
#pragma once

#include <sinew/core/options.h>
#include <sinew/physics/elasticity.h>
#include <sinew/physics/pair_force.h>

namespace sinew {

/// Strength of the bonds of a solid. Strains are changes of a bond's length over its rest length.
struct BondStrength {
  double stiffness = 0;        ///< N/m
  double breaking_strain = 0;  ///< in tension; 0: never breaks
  double yield_strain = 0;     ///< in tension and compression; 0: never creeps
  double creep_rate = 0;       ///< of what exceeds the yield strain, 1/s
};

struct Material {
  MaterialModel model = MaterialModel::paper;
  Cohesion cohesion = Cohesion::all;
  PairForce pair;
  BondStrength bond;
  double volume_stiffness = 0;  ///< K_v, Pa
  double mass = 0;              ///< of a particle, kg
  double damping = 0;           ///< C of eq. 2, kg/s
  DampingForm damping_form = DampingForm::paper;

  double young_modulus() const;  ///< Pa, Hill average over directions
  double stiffness() const;      ///< the stiffest of contact, tension and bonds, N/m
  /// Of the packing, in its own axes, Pa.
  CubicConstants constants() const;
};

/// The properties of a body that its material depends on.
struct BodyShape {
  double radius = 0;                ///< of a particle, m
  double mass = 0;                  ///< of a particle, kg
  double length = 0;                ///< along the longest principal axis, m
  double gyration = 0;              ///< of its section about the weaker axis, m
  Mat3 lattice = Mat3::Identity();  ///< columns: the packing's axes
};

/// That of a bar with the same moments as the particles at `rest` (m).
BodyShape shape_of(const Points& rest, double radius, double mass);

/// The constants for particles of `radius` (m) and `mass` (kg).
Material make_material(const MaterialOptions& settings, const BodyShape& shape);
Material make_material(const MaterialOptions& settings, double radius, double mass);

/// The lowest frequency at which a free bar of that shape bends (Timoshenko's estimate), rad/s.
double first_bending_frequency(const Material& material, const BodyShape& shape);
/// The damping ratio that eq. 2 gives that mode, and the damping constant (kg/s) for a ratio.
double damping_ratio(const Material& material, const BodyShape& shape);
double damping_for(double ratio, const Material& material, const BodyShape& shape);

}  // namespace sinew
