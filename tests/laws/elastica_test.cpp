// SPDX-License-Identifier: GPL-3.0-or-later
// A slender bonded beam bends as far as the elastica under the same end load.
#include <gtest/gtest.h>
#include <Eigen/Sparse>

#include <sinew/body/solid.h>

#include "support/world.h"

namespace sinew::elastica_test {

using Vector = Eigen::VectorXd;

constexpr double r = 0.01;
constexpr int planes = 5, lengths_of_height = 20;

/// A square beam, clamped at its lowest plane, that finds its equilibrium by Newton's method: the
/// test linearizes the bonds itself, the forces are those of the simulation.
class SlenderBeam {
 public:
  SlenderBeam()
      : rest_(test::fcc_box(planes, planes, (planes - 1) * lengths_of_height + 1, r)),
        material_(bonded()),
        solid_(material_, rest_),
        now_(particles_at(rest_, r, material_.mass)) {
    Box box;
    for (const Vec3& point : rest_) box.extend(point);
    base_ = box.min().z(), length_ = box.max().z() - base_;
    free_.assign(rest_.size(), -1);
    for (std::size_t i = 0; i < rest_.size(); ++i)
      if (rest_[i].z() > base_ + 1e-9) free_[i] = freedoms_++;
  }

  double length() const { return length_; }

  /// Displacement of the end's center under a load (N) along x.
  Vec3 end_under(double load) {
    for (int n = 0; n < 30; ++n) {
      const Vector residual = loads(load) + forces();
      if (residual.norm() < 1e-7 * load) return end();
      Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(tangent());
      move(solver.solve(residual));
    }
    ADD_FAILURE() << "no balance under " << load << " N";
    return end();
  }

 private:
  static Material bonded() {
    MaterialOptions settings;
    settings.model = MaterialModel::bonded;
    return make_material(settings, {r, 1});
  }
  bool at_end(std::size_t i) const { return rest_[i].z() > base_ + length_ - 1e-9; }

  Vector loads(double load) const {
    double count = 0;
    for (std::size_t i = 0; i < rest_.size(); ++i) count += at_end(i);
    Vector all = Vector::Zero(3 * freedoms_);
    for (std::size_t i = 0; i < rest_.size(); ++i)
      if (at_end(i)) all[3 * free_[i]] = load / count;
    return all;
  }

  Vector forces() {
    Forces forces;
    solid_.forces(now_, forces);
    Vector all(3 * freedoms_);
    for (std::size_t i = 0; i < rest_.size(); ++i)
      if (free_[i] >= 0) all.segment<3>(3 * free_[i]) = forces.pair[i];
    return all;
  }

  Eigen::SparseMatrix<double> tangent() const {
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](int row, int column, const Mat3& block) {
      if (row < 0 || column < 0) return;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) entries.emplace_back(3 * row + a, 3 * column + b, block(a, b));
    };
    for (std::size_t i = 0; i < rest_.size(); ++i)
      for (const Bonds* bonds : {&solid_.bonds().nearest, &solid_.bonds().second})
        for_each_bond(*bonds, now_, i, [&](const BondNow& bond) {
          const Vec3 e = bond.offset / bond.distance;
          const double left = bond.spring.length / bond.distance;
          const Mat3 slope =
              bond.spring.stiffness * ((1 - left) * Mat3::Identity() + left * e * e.transpose());
          add(free_[i], free_[i], slope);
          add(free_[i], free_[bond.neighbor], -slope);
        });
    Eigen::SparseMatrix<double> matrix(3 * freedoms_, 3 * freedoms_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

  void move(const Vector& by) {
    // No bond may rotate much in one iteration: Newton's method would leave the beam's branch.
    const double fraction = std::min(1.0, length_ / 10 / by.cwiseAbs().maxCoeff());
    for (std::size_t i = 0; i < rest_.size(); ++i)
      if (free_[i] >= 0)
        now_.set_position(i, now_.position(i) + fraction * by.segment<3>(3 * free_[i]));
  }

  Vec3 end() const {
    Vec3 sum = Vec3::Zero();
    double count = 0;
    for (std::size_t i = 0; i < rest_.size(); ++i)
      if (at_end(i)) sum += now_.position(i) - rest_[i], count += 1;
    return sum / count;
  }

  Points rest_;
  Material material_;
  Solid solid_;
  Particles now_;
  double base_ = 0, length_ = 0;
  std::vector<int> free_;  ///< by particle: its place among those that move, or -1
  int freedoms_ = 0;
};

/// Displacement of the end of the elastica, over its length: sideways, and back along the beam
/// (elliptic integrals; Mattiasson, Int. J. Numer. Methods Eng. 17, 1981, 145).
struct Elastica {
  double load;  // P L^2 / (E I)
  double sideways, back;
};

TEST(Elastica, IsTheShapeOfASlenderBondedBeam) {
  SlenderBeam beam;
  const double L = beam.length(),
               little = 1e-5;  // N, of 7e-3 that bend it by a third of its length
  const double bending = little * L * L * L / (3 * beam.end_under(little).x());  // E I
  for (const Elastica& known : {Elastica{1, 0.30172, 0.05643},
                                {2, 0.49346, 0.16064},
                                {3, 0.60325, 0.25442},
                                {4, 0.66996, 0.32894},
                                {5, 0.71379, 0.38763}}) {
    const Vec3 end = beam.end_under(known.load * bending / (L * L));
    EXPECT_NEAR(end.x() / L, known.sideways, 0.01 * known.sideways) << known.load;
    EXPECT_NEAR(-end.z() / L, known.back, 0.01) << known.load;
  }
}

}  // namespace sinew::elastica_test
