// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/material/material.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/material/laws.h>

namespace sinew {
namespace {

double order_of(Packing packing) { return packing == Packing::random ? random_young : 1; }

/// k1 (Pa) for a Young's modulus (Pa).
double k1_of(const MaterialOptions& settings, const PackingStiffness& packing, Packing sites,
             const Mat3& lattice) {
  const CubicConstants of_k = fcc_constants(packing);
  const bool isotropic = packing.second > 0;
  const double shear = isotropic ? of_k.hill_shear_modulus() : hill_shear;
  double per_k = isotropic ? of_k.hill_young_modulus() : hill_young;
  if (keeps_volume(settings.model)) per_k = 2 * shear * (1 + settings.poisson_ratio);
  if (settings.modulus_direction)
    per_k = of_k.young_modulus(lattice.transpose() * *settings.modulus_direction);
  per_k *= order_of(sites);
  return settings.young_modulus / (2 * per_k);  // E = per_k k / d0, k = 4 k1 r = 2 k1 d0
}

PackingStiffness packing_of(const MaterialOptions& settings, Packing sites) {
  PackingStiffness packing;
  if (!has_bonds(settings.model)) return packing;
  if (is_isotropic(settings, sites)) packing.second = isotropic_second;
  if (keeps_volume(settings.model))
    packing.volume = volume_stiffness_for(settings.poisson_ratio, packing.second);
  return packing;
}

/// The strain at which bonds of such a material break so that a crack takes that energy per area
/// (J/m^2). A plane of normal n cuts |l n| / (2 V0) of the bonds l of each particle per area, with
/// k (s l)^2 / 2 in each; over all directions, |l n| is l / 2 on average.
double breaking_strain_for(double energy, double k, const PackingStiffness& packing, double r) {
  const double nearest = 2 * r, second = std::sqrt(2.0) * nearest;
  const double sum = 12 * k * std::pow(nearest, 3) + 6 * packing.second * k * std::pow(second, 3);
  return std::sqrt(8 * volume_per_particle(r) * energy / sum);
}

void bond(const MaterialOptions& settings, const PackingStiffness& packing, Material& material) {
  const double k = material.pair.contact_stiffness();
  const double breaking_strain =
      settings.fracture_energy
          ? breaking_strain_for(*settings.fracture_energy, k, packing, material.pair.r)
          : settings.breaking_strain.value_or(0);
  material.bond = {k, packing.second * k, breaking_strain,
                   yield_shear(settings.yield_strain.value_or(0), poisson_ratio_of(settings)),
                   settings.creep_rate.value_or(1)};
  if (settings.relaxation_shares && settings.relaxation_times)
    for (std::size_t b = 0; b < settings.relaxation_shares->size(); ++b)
      material.bond.branches[b] = {settings.relaxation_shares->at(b),
                                   settings.relaxation_times->at(b)};
  material.volume_stiffness = material.order * packing.volume * k / (2 * material.pair.r);
}

}  // namespace

double poisson_ratio_of(const MaterialOptions& settings) {
  constexpr double of_springs = 0.25;
  return keeps_volume(settings.model) ? settings.poisson_ratio : of_springs;
}

double yield_shear(double yield_strain, double poisson_ratio) {
  return yield_strain * (1 + poisson_ratio) * std::sqrt(2.0 / 3);
}

double local_volume_stiffness(const Material& material, double relative, double poisson_ratio) {
  return material.order * relative * volume_stiffness_for(poisson_ratio, isotropic_second) *
         material.pair.contact_stiffness() / (2 * material.pair.r);
}

std::size_t BondStrength::branch_count() const {
  return static_cast<std::size_t>(std::count_if(
      branches.begin(), branches.end(), [](const auto& one) { return one.modulus_ratio > 0; }));
}

double BondStrength::long_term() const {
  double left = 1;
  for (const MaxwellBranch& branch : branches) left -= branch.modulus_ratio;
  return left;
}

Material long_term(Material material) {
  const double left = material.bond.long_term();
  material.relaxed *= left;
  material.bond.stiffness *= left;
  material.bond.second *= left;
  material.bond.branches = {};
  return material;
}

PackingStiffness Material::packing() const {
  const double k_over_d0 = 2 * pair.k1 * relaxed;
  return {bond.second / (2 * pair.r * k_over_d0), volume_stiffness / (order * k_over_d0)};
}

double Material::young_modulus() const {
  if (bond.second > 0) return constants().hill_young_modulus();
  const double k_over_d0 = 2 * pair.k1 * relaxed;
  if (volume_stiffness <= 0) return hill_young * k_over_d0;
  const double K = bulk_of_bonds * k_over_d0 + volume_stiffness, G = hill_shear * k_over_d0;
  return 9 * K * G / (3 * K + G);
}

double Material::stiffness() const { return law_of(*this).stiffness(*this); }

CubicConstants Material::constants() const {
  const double k_over_d0 = 2 * pair.k1 * relaxed;
  CubicConstants constants = fcc_constants(packing());
  for (double* C : {&constants.C11, &constants.C12, &constants.C44}) *C *= order * k_over_d0;
  return constants;
}

Material make_material(const MaterialOptions& settings, const PackedBody& body) {
  const PackingStiffness packing = packing_of(settings, body.packing);
  Material material;
  material.model = settings.model;
  material.cohesion = settings.cohesion;
  PairForce& pair = material.pair;
  pair.r = body.radius;
  pair.a = settings.a * pair.r;
  pair.b = settings.b * pair.r;
  pair.k1 = settings.k1 ? *settings.k1 : k1_of(settings, packing, body.packing, body.lattice);
  pair.k2 = settings.k2.value_or(settings.lambda * pair.contact_stiffness() / (pair.b - pair.a));
  material.mass = body.mass;
  material.order = order_of(body.packing);
  if (has_bonds(settings.model)) bond(settings, packing, material);
  material.damping_form = settings.damping_form.value_or(
      has_bonds(settings.model) ? DampingForm::rigid : DampingForm::paper);
  material.friction = settings.friction;
  material.damping = settings.damping * std::sqrt(pair.contact_stiffness() * body.mass);
  return material;
}

void check_variant(const Material& now, const Material& next) {
  for (const double value : {next.pair.k1, next.pair.k2, next.pair.a, next.bond.stiffness,
                             next.bond.second, next.damping, next.volume_stiffness, next.friction})
    if (!is_computable(value) || value < 0)
      throw bad_input("the material has a constant of " + three_digits(value),
                      "give constants that are finite and not negative");
  const BondStrength &a = now.bond, &b = next.bond;
  if (now.model != next.model || now.cohesion != next.cohesion || now.pair.r != next.pair.r ||
      now.pair.b != next.pair.b || now.mass != next.mass || (a.second > 0) != (b.second > 0) ||
      (a.breaking_strain > 0) != (b.breaking_strain > 0) ||
      (a.yield_shear > 0) != (b.yield_shear > 0) || a.branch_count() != b.branch_count())
    throw bad_input("the material has another model, or other particles, than the body",
                    "begin a simulation of that body");
}

}  // namespace sinew
