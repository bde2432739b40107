// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel's functions for a material: those of its model, or those that its law brings.
//
//     const kernel::LawFunctions<Real> work = law_functions(body, kernel);
#pragma once

#include <string>

#include <sinew/body/body.h>
#include <sinew/core/error.h>
#include <sinew/kernel/kernel.h>
#include <sinew/material/laws.h>

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
  const Material& material = body.material;
  const kernel::OwnLaw* own = law_of(material).kernel;
  if (own == nullptr) return kernel.law[kernel_law(body)];
  const std::string name(law_of(material).name);
  if (bonds_change(material))
    throw bad_input("the bonds of " + name + " keep their lengths, and never break",
                    "leave out strength and relaxation");
  if (own->in<Real>().count == nullptr)
    throw bad_input("the law " + name + " has no steps in this precision",
                    "set solver.precision to the other one");
  return own->in<Real>();
}

}  // namespace sinew
