// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/material.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include <sinew/core/particles.h>
#include <sinew/physics/laws.h>

namespace sinew {
namespace {

// Of the first mode of a free bar: w = this sqrt(E I / (rho A)) / L^2, and the mean square of its
// slope over that of its deflection, times L^2 (Blevins, Formulas for Natural Frequency and Mode
// Shape, 1979).
constexpr double free_bar_frequency = 22.373, free_bar_slope = 49.48;
constexpr double shear_coefficient = 5.0 / 6;

/// k1 (Pa) for a Young's modulus (Pa).
double k1_of(const MaterialOptions& settings, double volume_stiffness, const Mat3& lattice) {
  const CubicConstants of_k = fcc_constants(volume_stiffness);
  double per_k = settings.model == MaterialModel::bonded_volume
                     ? 2 * hill_shear * (1 + settings.poisson_ratio)
                     : hill_young;
  if (settings.modulus_direction)
    per_k = of_k.young_modulus(lattice.transpose() * *settings.modulus_direction);
  return settings.young_modulus / (2 * per_k);  // E = per_k k / d0, k = 4 k1 r = 2 k1 d0
}

void bond(const MaterialOptions& settings, double volume_stiffness, Material& material) {
  const double k = material.pair.contact_stiffness();
  material.bond = {k, settings.breaking_strain.value_or(0), settings.yield_strain.value_or(0),
                   settings.creep_rate};
  material.volume_stiffness = volume_stiffness * k / (2 * material.pair.r);
}

}  // namespace

double Material::young_modulus() const {
  const double k_over_d0 = 2 * pair.k1;
  if (volume_stiffness <= 0) return hill_young * k_over_d0;
  const double K = bulk_of_bonds * k_over_d0 + volume_stiffness, G = hill_shear * k_over_d0;
  return 9 * K * G / (3 * K + G);
}

double Material::stiffness() const {
  return std::max(pair.contact_stiffness(),
                  law_of(*this).has_bonds ? bond.stiffness : pair.tension_stiffness());
}

CubicConstants Material::constants() const {
  const double k_over_d0 = 2 * pair.k1;
  CubicConstants constants = fcc_constants(volume_stiffness / k_over_d0);
  for (double* C : {&constants.C11, &constants.C12, &constants.C44}) *C *= k_over_d0;
  return constants;
}

BodyShape shape_of(const Points& rest, double radius, double mass) {
  Vec3 center = Vec3::Zero();
  for (const Vec3& point : rest) center += point / static_cast<double>(rest.size());
  Mat3 spread = Mat3::Zero();
  for (const Vec3& point : rest)
    spread += (point - center) * (point - center).transpose() / static_cast<double>(rest.size());
  const Vec3 moments =
      Eigen::SelfAdjointEigenSolver<Mat3>(spread, Eigen::EigenvaluesOnly).eigenvalues();
  BodyShape shape{radius, mass, 0, 0, Mat3::Identity()};
  // A single particle is as long and as thick as itself.
  shape.length = std::max(2 * radius, std::sqrt(12 * std::max(0.0, moments[2])));
  shape.gyration = std::max(radius / std::sqrt(3.0), std::sqrt(std::max(0.0, moments[0])));
  return shape;
}

Material make_material(const MaterialOptions& settings, const BodyShape& shape) {
  const double volume_stiffness = settings.model == MaterialModel::bonded_volume
                                      ? volume_stiffness_for(settings.poisson_ratio)
                                      : 0;
  Material material;
  material.model = settings.model;
  material.cohesion = settings.cohesion;
  PairForce& pair = material.pair;
  pair.r = shape.radius;
  pair.a = settings.a * pair.r;
  pair.b = settings.b * pair.r;
  pair.k1 = settings.k1 ? *settings.k1 : k1_of(settings, volume_stiffness, shape.lattice);
  pair.k2 = settings.k2.value_or(settings.lambda * pair.contact_stiffness() / (pair.b - pair.a));
  material.mass = shape.mass;
  if (settings.model != MaterialModel::paper) bond(settings, volume_stiffness, material);
  material.damping_form = settings.damping_form;
  material.damping = settings.damping_ratio
                         ? damping_for(*settings.damping_ratio, material, shape)
                         : settings.damping * std::sqrt(pair.contact_stiffness() * shape.mass);
  return material;
}

Material make_material(const MaterialOptions& settings, double radius, double mass) {
  return make_material(settings, BodyShape{radius, mass, 2 * radius, radius, Mat3::Identity()});
}

double first_bending_frequency(const Material& material, const BodyShape& shape) {
  const CubicConstants constants = material.constants();
  const double density = material.mass / volume_per_particle(shape.radius);
  const double E = constants.hill_young_modulus(), G = constants.hill_shear_modulus();
  const double bending =
      free_bar_frequency * std::sqrt(E / density) * shape.gyration / (shape.length * shape.length);
  // Compact bodies shear rather than bend: the same mode with the shear stiffness alone.
  const double shear = std::sqrt(free_bar_slope * shear_coefficient * G / density) / shape.length;
  return 1 / std::sqrt(1 / (bending * bending) + 1 / (shear * shear));
}

/// The damping rate of eq. 2 for a velocity field v is C / m d0^2 / 6 |grad v|^2 / v^2.
double damping_ratio(const Material& material, const BodyShape& shape) {
  const double d0 = 2 * shape.radius;
  const double rate = material.damping / material.mass * d0 * d0 / 6 * free_bar_slope /
                      (shape.length * shape.length);
  return rate / (2 * first_bending_frequency(material, shape));
}

double damping_for(double ratio, const Material& material, const BodyShape& shape) {
  Material unit = material;
  unit.damping = 1;
  return ratio / damping_ratio(unit, shape);
}

}  // namespace sinew
