// SPDX-License-Identifier: GPL-3.0-or-later
// From what a user knows (Young's modulus, density, damping) to the constants of the particles, for
// closest-packed bodies with bonds of stiffness k at distance d0 = 2r.
#pragma once

#include "core/settings.h"
#include "physics/pair_force.h"

namespace sinew {

struct Material {
  PairForce pair;
  double mass = 0;     ///< of a particle, kg
  double damping = 0;  ///< C of eq. 2, kg/s
  DampingForm damping_form = DampingForm::paper;

  double young_modulus() const;  ///< Pa, Hill average over directions
  double stiffness() const;      ///< the larger of contact and tension, N/m
};

/// E = 2.70 k1 (Hill average of E / (k / d0) = 1.3505 with k = 4 k1 r).
inline constexpr double young_modulus_over_k1 = 2.701;

/// Poisson's ratio (Hill) that central forces in a closest packing fix.
inline constexpr double poisson_ratio_hill = 0.261;

/// The constants for particles of `radius` (m) and `mass` (kg).
Material make_material(const MaterialSettings& settings, double radius, double mass);

}  // namespace sinew
