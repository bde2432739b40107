// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel's functions for a material: those of its model, or those that its law brings.
//
//     const kernel::LawFunctions<Real> work = law_functions(body, kernel);
#pragma once

#include <sinew/body/body.h>
#include <sinew/kernel/kernel.h>
#include <sinew/material/laws.h>
#include <sinew/world/features.h>

namespace sinew {

/// The law of the kernel that a body's resembles most: what lists it reads.
inline kernel::PairLaw kernel_law(const Body& body) {
  const Material& material = body.material;
  const ForceLaw& law = law_of(material);
  if (!law.has_memory)
    return body.pass_through.any() ? kernel::between_listed : kernel::between_all;
  if (!law.has_bonds) return kernel::among_neighbors;
  return bonds_change(material) ? kernel::changing_springs : kernel::springs;
}

/// Throws bad input for changing bonds, or a precision, that the material's own law does not know.
template <class Real>
kernel::LawFunctions<Real> law_functions(const Body& body, const kernel::Functions<Real>& kernel) {
  const kernel::OwnLaw* own = law_of(body.material).kernel;
  if (own == nullptr) return kernel.law[kernel_law(body)];
  Features features = features_of(body);
  if (own->in<Real>().count == nullptr) features.insert(Feature::law_without_precision);
  refuse_conflicts(Feature::lists, features);
  return own->in<Real>();
}

}  // namespace sinew
