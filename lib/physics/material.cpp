// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/material.h"

#include <algorithm>
#include <cmath>

namespace sinew {

double Material::young_modulus() const { return young_modulus_over_k1 * pair.k1; }

double Material::stiffness() const {
  return std::max(pair.contact_stiffness(), pair.tension_stiffness());
}

Material make_material(const MaterialSettings& settings, double radius, double mass) {
  Material material;
  PairForce& pair = material.pair;
  pair.r = radius;
  pair.a = settings.a * radius;
  pair.b = settings.b * radius;
  pair.k1 = settings.k1.value_or(settings.young_modulus / young_modulus_over_k1);
  pair.k2 = settings.k2.value_or(settings.lambda * pair.contact_stiffness() / (pair.b - pair.a));
  material.mass = mass;
  material.damping = settings.damping * std::sqrt(pair.contact_stiffness() * mass);
  material.damping_form = settings.damping_form;
  return material;
}

}  // namespace sinew
