// SPDX-License-Identifier: GPL-3.0-or-later
// The elastic constants of packings, from static equilibrium: the skin of a body is strained, the
// rest gives way, and strain and stress are read off deep inside. The springs are the product's,
// the solver is Eigen's.
#include <gtest/gtest.h>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/LU>
#include <Eigen/SparseCore>

#include <sinew/body/solid.h>
#include <sinew/mesh/clean.h>
#include <sinew/scene/filling.h>
#include <sinew/scene/prepare.h>
#include "mesh/shapes.h"

namespace sinew::packing_isotropy_test {

using Voigt = Eigen::Matrix<double, 6, 6>;
using Strain = Eigen::Matrix<double, 6, 1>;  // xx, yy, zz, and the engineering shears yz, zx, xy

Settings bonded(Packing packing, int seed) {
  Settings settings;
  settings.body.count = 6000;
  settings.body.packing = packing;
  settings.body.seed = seed;
  settings.body.lattice_rotation = std::nullopt;
  settings.material.model = MaterialModel::bonded;
  return settings;
}

Strain voigt(const Mat3& e) {
  return {e(0, 0), e(1, 1), e(2, 2), e(1, 2) + e(2, 1), e(2, 0) + e(0, 2), e(0, 1) + e(1, 0)};
}

Mat3 matrix(const Strain& e) {
  Mat3 m;
  m << e[0], e[5] / 2, e[4] / 2, e[5] / 2, e[1], e[3] / 2, e[4] / 2, e[3] / 2, e[2];
  return m;
}

struct Shape {
  const char* name;
  PolygonSoup mesh;
  bool is_box;
};

std::array<Shape, 2> shapes_of_tests() {
  return {{{"ball", shapes::sphere(1, 4), false},
           {"box", shapes::box({-1, -0.9, -0.8}, {1, 0.9, 0.8}), true}}};
}

class Equilibrium {
 public:
  Equilibrium(const Shape& shape, const Settings& settings) : is_box_(shape.is_box) {
    const Surface surface = clean(shape.mesh);
    const Filling filling = fill_body(settings, surface);
    rest_ = positions_of(filling.particles);
    volume_share_ = filling.volume_share;
    volume_share_.resize(rest_.size(), 1);
    const Material material = material_of(settings, filling.particles);
    young_modulus_ = settings.material.young_modulus;
    const RestNeighbors near = rest_neighbors(rest_, material.pair.r, material.bond.second > 0);
    bonds_ = make_bonds(rest_, near.all(), material, filling.particles.id,
                        bond_factors(rest_, near, material, filling.volume_share));
    const Box box = bounds(rest_);
    const double half = box.sizes().minCoeff() / 2;
    volume_ = volume_per_particle(filling.particles.radius);
    for (const Vec3& place : rest_) {
      const double out = out_of(place - box.center(), box.sizes() / 2);
      held_.push_back(half - out < 3.2 * filling.particles.radius ? 1 : 0);
      deep_.push_back(half - out > 0.4 * half ? 1 : 0);
    }
    build();
  }

  /// Over the modulus that was asked for.
  std::array<double, 2> modulus_range() const {
    Voigt strains, stresses;
    for (int k = 0; k < 6; ++k) {
      const Points moved = strained(matrix(Strain::Unit(k)));
      strains.col(k) = voigt(strain_inside(moved));
      stresses.col(k) = stress_inside(moved);
    }
    const Voigt compliance = (stresses * strains.inverse()).inverse();
    double least = HUGE_VAL, most = 0;
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int k = 0; k < 2000; ++k) {
      const Vec3 n = Vec3(normal(random), normal(random), normal(random)).normalized();
      Strain of_n = voigt(n * n.transpose());
      of_n.tail<3>() /= 2;
      const double modulus = 1 / of_n.dot(compliance * of_n) / young_modulus_;
      least = std::min(least, modulus), most = std::max(most, modulus);
    }
    return {least, most};
  }

 private:
  /// In a ball's radii, or a box's largest coordinate.
  double out_of(const Vec3& from, const Vec3& half) const {
    return is_box_ ? from.cwiseAbs().cwiseQuotient(half).maxCoeff() * half.minCoeff() : from.norm();
  }

  template <class Visit>
  void for_each_bond(const Visit& visit) const {
    for (const Bonds* bonds : {&bonds_.nearest, &bonds_.second})
      for (std::size_t i = 0; i < rest_.size(); ++i)
        for (std::uint32_t e = bonds->neighbors.first[i]; e < bonds->neighbors.first[i + 1]; ++e)
          visit(i, bonds->neighbors.neighbor[e], bonds->stiffness[e]);
  }

  static double unit(const Vec3& apart, int axis) { return apart[axis] / apart.norm(); }

  void build() {
    std::vector<Eigen::Triplet<double>> entries;
    for_each_bond([&](std::size_t i, std::size_t j, double k) {
      const Vec3 apart = rest_[i] - rest_[j];
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          const double value = k * unit(apart, a) * unit(apart, b);
          entries.emplace_back(3 * i + a, 3 * i + b, value);
          entries.emplace_back(3 * i + a, 3 * j + b, -value);
        }
    });
    const auto size = static_cast<Eigen::Index>(3 * rest_.size());
    stiffness_.resize(size, size);
    stiffness_.setFromTriplets(entries.begin(), entries.end());
  }

  /// Displacements with the skin strained and no force on the others.
  Points strained(const Mat3& strain) const {
    Eigen::VectorXd given(3 * rest_.size()), free(3 * rest_.size());
    for (std::size_t i = 0; i < rest_.size(); ++i) {
      given.segment<3>(3 * i) = strain * rest_[i];
      free.segment<3>(3 * i).setConstant(held_[i] != 0 ? 0 : 1);
    }
    // Conjugate gradients on the free part, from the affine state.
    Eigen::VectorXd x = given;
    Eigen::VectorXd residual = -(stiffness_ * x).cwiseProduct(free), search = residual;
    const double enough = 1e-14 * residual.squaredNorm();
    for (double now = residual.squaredNorm(); now > enough;) {
      const Eigen::VectorXd along = (stiffness_ * search).cwiseProduct(free);
      const double step = now / search.dot(along);
      x += step * search;
      residual -= step * along;
      const double next = residual.squaredNorm();
      search = residual + next / now * search;
      now = next;
    }
    Points moved(rest_.size());
    for (std::size_t i = 0; i < rest_.size(); ++i) moved[i] = x.segment<3>(3 * i);
    return moved;
  }

  /// Fits displacements by least squares.
  Mat3 strain_inside(const Points& moved) const {
    Vec3 center = Vec3::Zero(), by = Vec3::Zero();
    double count = 0;
    for (std::size_t i = 0; i < rest_.size(); ++i)
      if (deep_[i] != 0) center += rest_[i], by += moved[i], ++count;
    center /= count, by /= count;
    Mat3 product = Mat3::Zero(), spread = Mat3::Zero();
    for (std::size_t i = 0; i < rest_.size(); ++i)
      if (deep_[i] != 0) {
        product += (moved[i] - by) * (rest_[i] - center).transpose();
        spread += (rest_[i] - center) * (rest_[i] - center).transpose();
      }
    const Mat3 gradient = product * spread.inverse();
    return (gradient + gradient.transpose()) / 2;
  }

  /// Half of each bond's virial belongs to its particle.
  Strain stress_inside(const Points& moved) const {
    Mat3 sum = Mat3::Zero();
    for_each_bond([&](std::size_t i, std::size_t j, double k) {
      if (deep_[i] == 0) return;
      const Vec3 apart = rest_[i] - rest_[j];
      const double longer = (moved[i] - moved[j]).dot(apart) / apart.norm();
      sum += k * longer / apart.norm() / 2 * apart * apart.transpose();
    });
    double volume = 0;
    for (std::size_t i = 0; i < rest_.size(); ++i)
      volume += deep_[i] != 0 ? volume_share_[i] * volume_ : 0;
    Strain stress = voigt(sum / volume);
    stress.tail<3>() /= 2;
    return stress;
  }

  bool is_box_;
  Points rest_;
  std::vector<double> volume_share_;
  std::vector<char> held_, deep_;
  SolidBonds bonds_;
  double young_modulus_ = 0, volume_ = 0;
  Eigen::SparseMatrix<double, Eigen::RowMajor> stiffness_;
};

std::array<double, 2> modulus_range(const Shape& shape, const Settings& settings) {
  const std::array<double, 2> range = Equilibrium(shape, settings).modulus_range();
  std::printf("%s, seed %d: modulus %.3f to %.3f\n", shape.name, settings.body.seed, range[0],
              range[1]);
  return range;
}

void expect_isotropic(Packing packing) {
  for (const Shape& shape : shapes_of_tests())
    for (const int seed : {1, 2}) {
      const auto [least, most] = modulus_range(shape, bonded(packing, seed));
      EXPECT_GT(least, 0.97) << shape.name;
      EXPECT_LT(most, 1.03) << shape.name;
      EXPECT_LT(most / least, 1.03) << shape.name;
    }
}

TEST(PackingIsotropy, OfFccIsWithin3Percent) { expect_isotropic(Packing::fcc); }
TEST(PackingIsotropy, OfRandomIsWithin3Percent) { expect_isotropic(Packing::random); }
TEST(PackingIsotropy, OfConformalIsWithin3Percent) { expect_isotropic(Packing::conformal); }

/// Closed form of the infinite crystal of twelve bonds: E[111] / E[100] = 1.8. HCP is nearer.
TEST(PackingIsotropy, OfTwelveBondsIsThatOfTheCrystal) {
  for (const auto& [packing, ratio] : {std::pair{Packing::fcc, 1.8}, {Packing::hcp, 1.35}})
    for (const Shape& shape : shapes_of_tests()) {
      Settings settings = bonded(packing, 1);
      settings.material.isotropic = false;
      const auto [least, most] = modulus_range(shape, settings);
      EXPECT_NEAR(most / least, ratio, 0.03) << shape.name;
    }
}

}  // namespace sinew::packing_isotropy_test
