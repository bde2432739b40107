// SPDX-License-Identifier: GPL-3.0-or-later
// The one table of laws of force between particles. The steppers, the metrics and the report's
// curves take a law from here: to add one, add its choice in core/options.h and its row in
// laws.cpp. A program may bring one of its own as Material::law: a row like these.
//
//     const ForceLaw& law = law_of(material);
//     const double newtons = law.force(material, 2.1 * material.pair.r);
#pragma once

#include <span>
#include <string_view>

#include <sinew/material/material.h>

namespace sinew {

namespace kernel {
struct OwnLaw;  // kernel/kernel.h
}

/// Forces in N, positive repels; distances in m; energies in J.
struct ForceLaw {
  MaterialModel model;
  Cohesion cohesion;
  std::string_view name;  ///< what a scene calls it
  bool has_bonds;         ///< neighbors at rest are springs, which may creep and break
  bool has_memory;        ///< it matters who was whose neighbor at rest

  /// Between two particles at distance d that were no neighbors at rest, or have parted.
  double (*force)(const Material&, double d);
  double (*energy)(const Material&, double d);
  /// The same between neighbors at rest.
  double (*bond_force)(const Material&, const BondSpring&, double d);
  double (*bond_energy)(const Material&, const BondSpring&, double d);

  /// The stiffest of its springs at rest, N/m.
  double (*stiffness)(const Material&);
  /// Particles that were no neighbors at rest, or have parted, feel each other within it, m.
  double (*range)(const Material&);
  /// Whether pull and push are equally stiff at rest: vibrations about it have frequencies, which
  /// bound the time step.
  bool (*is_linear_at_rest)(const Material&);

  std::string_view remark;  ///< for the curve of its force; "" for none
  /// Its steps, where a program brings the law; none: those of the kernel.
  const kernel::OwnLaw* kernel = nullptr;
};

std::span<const ForceLaw> force_laws();

/// The law of a material: its own, or that of its model. Bonded models know one cohesion.
const ForceLaw& law_of(const Material& material);

/// Whether it has bonds that break, creep or relax: its forces then depend on its history.
bool bonds_change(const Material& material);

}  // namespace sinew
