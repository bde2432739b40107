// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/material/laws.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sinew {
namespace {

double eq_1(const Material& material, double d) { return material.pair.force(d); }
double eq_1_energy(const Material& material, double d) { return material.pair.potential(d); }

/// Returns the part of eq. 1 below contact alone.
double repulsion(const Material& material, double d) {
  return d < 2 * material.pair.r ? material.pair.force(d) : 0;
}
double repulsion_energy(const Material& material, double d) {
  const PairForce& pair = material.pair;
  return d < 2 * pair.r ? pair.potential(d) - pair.potential(2 * pair.r) : 0;
}

double eq_1_bond(const Material& material, const BondSpring&, double d) {
  return material.pair.force(d);
}
double eq_1_bond_energy(const Material& material, const BondSpring&, double d) {
  return material.pair.potential(d);
}

double spring(const Material&, const BondSpring& spring, double d) {
  return -spring.stiffness * (d - spring.length);
}
double spring_energy(const Material&, const BondSpring& spring, double d) {
  return spring.stiffness / 2 * (d - spring.length) * (d - spring.length);
}

double stiffness_of_eq_1(const Material& material) {
  return std::max(material.pair.contact_stiffness(), material.pair.tension_stiffness());
}
double stiffness_of_springs(const Material& material) {
  return std::max(material.pair.contact_stiffness(), material.bond.stiffness);
}

double whole_range(const Material& material) { return material.pair.b; }
double contact_range(const Material& material) { return 2 * material.pair.r; }

bool is_even(const Material& material) { return std::abs(material.pair.lambda() - 1) < 1e-3; }
bool always(const Material&) { return true; }

constexpr std::string_view bonded_remark =
    " Rest neighbors are held by bonds instead; others feel its repulsion.";

constexpr std::array<ForceLaw, 4> laws = {{
    {MaterialModel::paper, Cohesion::all, "paper", false, false, eq_1, eq_1_energy, eq_1_bond,
     eq_1_bond_energy, stiffness_of_eq_1, whole_range, is_even, ""},
    {MaterialModel::paper, Cohesion::initial_neighbors, "paper, initial_neighbors", false, true,
     repulsion, repulsion_energy, eq_1_bond, eq_1_bond_energy, stiffness_of_eq_1, contact_range,
     is_even, ""},
    {MaterialModel::bonded, Cohesion::all, "bonded", true, true, repulsion, repulsion_energy,
     spring, spring_energy, stiffness_of_springs, contact_range, always, bonded_remark},
    {MaterialModel::bonded_volume, Cohesion::all, "bonded_volume", true, true, repulsion,
     repulsion_energy, spring, spring_energy, stiffness_of_springs, contact_range, always,
     bonded_remark},
}};

}  // namespace

std::span<const ForceLaw> force_laws() { return laws; }

const ForceLaw& law_of(const Material& material) {
  if (material.law != nullptr) return *material.law;
  for (const ForceLaw& law : laws)
    if (law.model == material.model && (law.has_bonds || law.cohesion == material.cohesion))
      return law;
  return laws.front();
}

bool bonds_change(const Material& material) {
  return law_of(material).has_bonds &&
         (material.bond.breaking_strain > 0 || material.bond.yield_shear > 0 ||
          material.bond.branch_count() > 0);
}

}  // namespace sinew
