// SPDX-License-Identifier: GPL-3.0-or-later
// Elastic constants against the closed forms of a lattice of central bonds, and against the
// strained filled lattice itself.
#include <sinew/material/elasticity.h>

#include <gtest/gtest.h>

#include <sinew/body/solid.h>

#include "support/world.h"

namespace sinew::elasticity_test {

constexpr double r = 0.01;

Material material_of(MaterialModel model, double poisson_ratio = 0.45, bool isotropic = false) {
  MaterialOptions settings;
  settings.model = model;
  settings.isotropic = isotropic;
  settings.poisson_ratio = poisson_ratio;
  return make_material(settings, {r, 1000 * volume_per_particle(r)});
}

TEST(FccConstants, AreThoseOfCentralBonds) {
  const CubicConstants C = fcc_constants();
  EXPECT_NEAR(C.C11, std::sqrt(2.0), 1e-15);
  EXPECT_EQ(C.C12, C.C44);  // Cauchy
  EXPECT_NEAR(C.bulk_modulus(), bulk_of_bonds, 1e-12);
  EXPECT_NEAR(C.hill_young_modulus(), hill_young, 1e-4);
  EXPECT_NEAR(C.hill_shear_modulus(), hill_shear, 1e-4);
  EXPECT_NEAR(C.hill_poisson_ratio(), hill_poisson, 5e-4);
}

TEST(FccConstants, AlongDirections) {
  const CubicConstants C = fcc_constants();
  EXPECT_NEAR(C.young_modulus({1, 0, 0}), 2 * std::sqrt(2.0) / 3, 1e-12);
  EXPECT_NEAR(C.young_modulus({1, 1, 0}), std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(C.young_modulus({1, 1, 1}), 1.6971, 1e-4);
  EXPECT_NEAR(C.young_modulus({0, -5, 0}), C.young_modulus({1, 0, 0}), 1e-12);
  EXPECT_NEAR(C.poisson_ratio({1, 0, 0}), 1.0 / 3, 1e-12);
}

TEST(VolumeStiffness, GivesThePoissonRatioAskedFor) {
  EXPECT_NEAR(volume_stiffness_for(0.45), 4.233, 1e-3);
  for (const double nu : {0.27, 0.3, 0.4, 0.45})
    EXPECT_NEAR(fcc_constants({0, volume_stiffness_for(nu)}).hill_poisson_ratio(), nu, 5e-4);
  EXPECT_NEAR(volume_stiffness_for(0.26), 0, 1e-3);
  // Along a cube axis, for stiffnesses of 0, 1, 2, 3 and 4.233 k / d0.
  const double along[] = {.333, .414, .442, .457, .467}, K[] = {0, 1, 2, 3, 4.233};
  for (int n = 0; n < 5; ++n)
    EXPECT_NEAR(fcc_constants({0, K[n]}).poisson_ratio({1, 0, 0}), along[n], 1e-3);
}

TEST(VolumeStiffness, OfIsotropicBondsGivesThePoissonRatioAskedFor) {
  for (const double nu : {0.25, 0.3, 0.4, 0.45, 0.49}) {
    const CubicConstants C = material_of(MaterialModel::bonded_volume, nu, true).constants();
    EXPECT_NEAR(C.hill_poisson_ratio(), nu, 1e-12);
    for (const Vec3& along : {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(3, -1, 7)}) {
      EXPECT_NEAR(C.young_modulus(along), 10e3, 1e-8);
      EXPECT_NEAR(C.poisson_ratio(along), nu, 1e-12);
    }
  }
}

TEST(Material, HasTheModulusAskedFor) {
  for (const auto model :
       {MaterialModel::paper, MaterialModel::bonded, MaterialModel::bonded_volume}) {
    EXPECT_NEAR(material_of(model).young_modulus(), 10e3, 30) << static_cast<int>(model);
    EXPECT_NEAR(material_of(model).constants().hill_young_modulus(), 10e3, 30);
  }
  MaterialOptions settings;
  settings.modulus_direction = Vec3(1, 1, 0);
  const PackedBody shape{r, 1, test::turned(Vec3::UnitZ(), 45), Packing::fcc};
  const Material along = make_material(settings, shape);  // the cube axis lies along the direction
  EXPECT_NEAR(along.constants().young_modulus({1, 0, 0}), 10e3, 1e-6);
}

double energy_of(const Material& material, const Points& rest, const Mat3& F) {
  const Particles moved = particles_at(test::affine(rest, F), r, material.mass);
  return material.model == MaterialModel::paper ? pair_energy(moved, material.pair)
                                                : Solid(material, rest).energy(moved);
}

/// Energy density of the inside of the packing under F, Pa: the additional energy of boxes longer
/// by four half-planes, in all three directions. Faces, edges and corners cancel exactly.
double energy_density(const Material& material, const Mat3& F) {
  double energy = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const auto size = [&](int axis) { return corner >> axis & 1 ? 11 : 7; };
    const int sign =
        size(0) + size(1) + size(2) == 33 || size(0) + size(1) + size(2) == 25 ? 1 : -1;
    energy += sign * energy_of(material, test::fcc_box(size(0), size(1), size(2), r), F);
  }
  return energy / (32 * volume_per_particle(r));
}

/// The second derivative of the energy density along a strain, Pa.
double modulus(const Material& material, const Mat3& strain) {
  const double e = 1e-4;
  const auto density = [&](double by) {
    return energy_density(material, Mat3(Mat3::Identity()) + by * e * strain);
  };
  return (density(1) - 2 * density(0) + density(-1)) / (e * e);
}

Mat3 unit(int i, int j) { return Vec3::Unit(i) * Vec3::Unit(j).transpose(); }

CubicConstants measured_constants(const Material& material) {
  const double C11 = modulus(material, unit(0, 0));
  return {C11, modulus(material, unit(0, 0) + unit(1, 1)) / 2 - C11, modulus(material, unit(0, 1))};
}

/// Mean stress of the inside of the packing under F, Pa, by the forces on its particles: the sum of
/// x f over bodies, of which faces, edges and corners cancel as in energy_density().
Mat3 stress(const Material& material, const Mat3& F) {
  Mat3 sum = Mat3::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    const auto size = [&](int axis) { return corner >> axis & 1 ? 11 : 7; };
    const int planes = size(0) + size(1) + size(2);
    const Points rest = test::fcc_box(size(0), size(1), size(2), r);
    const Particles moved = particles_at(test::affine(rest, F), r, material.mass);
    Forces forces;
    Solid(material, rest).forces(moved, forces);
    for (std::size_t i = 0; i < rest.size(); ++i)
      sum -=
          (planes == 33 || planes == 25 ? 1 : -1) * moved.position(i) * forces.pair[i].transpose();
  }
  return sum / (32 * volume_per_particle(r));
}

/// The column of the stiffness for a strain, in Voigt's order, Pa.
Eigen::Matrix<double, 6, 1> stiffness(const Material& material, const Mat3& strain) {
  const double e = 1e-5;
  const Mat3 slope = (stress(material, Mat3::Identity() + e * strain) -
                      stress(material, Mat3::Identity() - e * strain)) /
                     (2 * e);
  Eigen::Matrix<double, 6, 1> column;
  column << slope(0, 0), slope(1, 1), slope(2, 2), slope(1, 2), slope(2, 0), slope(0, 1);
  return column;
}

TEST(IsotropicBonds, AreStiffAlikeInEveryDirection) {
  for (const auto model : {MaterialModel::bonded, MaterialModel::bonded_volume}) {
    const Material material = material_of(model, 0.4, true);
    const double nu = model == MaterialModel::bonded ? 0.25 : 0.4;
    const double shear = 10e3 / (2 * (1 + nu)), lame = 2 * shear * nu / (1 - 2 * nu);
    Eigen::Matrix<double, 6, 6> expected = Eigen::Matrix<double, 6, 6>::Zero(), found;
    expected.topLeftCorner<3, 3>().setConstant(lame);
    for (int k = 0; k < 6; ++k) expected(k, k) += k < 3 ? 2 * shear : shear;
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      found.col(k) = stiffness(material, unit(k, k));
      found.col(3 + k) = stiffness(material, (unit(i, j) + unit(j, i)) / 2);
    }
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-6 * 10e3) << found;
  }
}

struct Solidity {
  MaterialModel model;
  bool isotropic;
};

class Moduli : public testing::TestWithParam<Solidity> {};

TEST_P(Moduli, OfTheFilledLatticeAreItsClosedForms) {
  const Material material = material_of(GetParam().model, 0.45, GetParam().isotropic);
  const CubicConstants C = material.constants();
  for (int axis = 0; axis < 3; ++axis) {
    const int next = (axis + 1) % 3;
    const double C11 = modulus(material, unit(axis, axis));
    EXPECT_NEAR(C11, C.C11, 1e-3 * C.C11);
    const double both = modulus(material, unit(axis, axis) + unit(next, next));
    EXPECT_NEAR(both / 2 - C11, C.C12, 1e-3 * C.C12);
    EXPECT_NEAR(modulus(material, unit(axis, next)), C.C44, 1e-3 * C.C44);
  }
}

TEST_P(Moduli, LetWavesTravelAsTheyShould) {
  const Material material = material_of(GetParam().model, 0.3, GetParam().isotropic);
  const double wave_number = 2 * std::numbers::pi / (20 * 2 * r);
  const Points rest = test::fcc_ball(9, r);
  const auto speed = [&](int along, int shift) {
    Points moved = rest;
    for (std::size_t i = 0; i < rest.size(); ++i)
      moved[i][shift] += 1e-5 * r * std::cos(wave_number * rest[i][along]);
    Forces forces;
    const Particles particles = particles_at(moved, r, material.mass);
    if (GetParam().model == MaterialModel::paper)
      pair_forces(particles, material, forces);
    else
      Solid(material, rest).forces(particles, forces);
    std::size_t middle = 0;
    for (std::size_t i = 0; i < rest.size(); ++i)
      if (rest[i].norm() < rest[middle].norm()) middle = i;
    return std::sqrt(-forces.pair[middle][shift] / material.mass / (1e-5 * r)) / wave_number;
  };
  const double density = material.mass / volume_per_particle(r);
  EXPECT_NEAR(speed(0, 0), std::sqrt(material.constants().C11 / density), 0.01 * speed(0, 0));
  EXPECT_NEAR(speed(0, 1), std::sqrt(material.constants().C44 / density), 0.01 * speed(0, 1));
}

TEST(BondedVolume, HasThePoissonRatioAskedForByMeasure) {
  for (const double nu : {0.26, 0.3, 0.35, 0.4, 0.45}) {
    MaterialOptions settings;
    settings.model = MaterialModel::bonded_volume;
    settings.poisson_ratio = nu;
    settings.isotropic = false;
    const CubicConstants C = measured_constants(make_material(settings, {r, 1}));
    EXPECT_NEAR(C.hill_poisson_ratio(), nu, 0.005);
  }
}

std::string name_of(const testing::TestParamInfo<Solidity>& info) {
  static const char* names[] = {"Paper", "Bonded", "BondedVolume"};
  return std::string(info.param.isotropic ? "Isotropic" : "") +
         names[static_cast<int>(info.param.model)];
}

INSTANTIATE_TEST_SUITE_P(Of, Moduli,
                         testing::Values(Solidity{MaterialModel::paper, false},
                                         Solidity{MaterialModel::bonded, false},
                                         Solidity{MaterialModel::bonded_volume, false},
                                         Solidity{MaterialModel::bonded, true},
                                         Solidity{MaterialModel::bonded_volume, true}),
                         name_of);

}  // namespace sinew::elasticity_test
