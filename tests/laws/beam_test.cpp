// SPDX-License-Identifier: GPL-3.0-or-later
// Beams of the filled lattice bend, sag, vibrate and twist as beam theory predicts from the moduli,
// in the limit of many particles. H is the distance of the outer planes (torsion: planes times
// spacing); n cells across leave errors of order 1 / n and 1 / n^2, which three sizes eliminate.
// They are 2, 4 and 6; SINEW_BEAM_CELLS=4,8,16 in the environment selects others, which take
// longer.
#include <gtest/gtest.h>
#include <Eigen/Sparse>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <sinew/body/solid.h>

#include "support/world.h"

namespace sinew::beam_test {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;
using Direct = Eigen::SimplicialLDLT<Matrix>;
using Iterative = Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper,
                                           Eigen::IncompleteCholesky<double>>;

constexpr double r = 0.01, stiffness = 1, mass = 1;  // of bonds and particles
constexpr int lengths_of_height = 10;
constexpr std::size_t max_solved_directly = 30'000;

/// A square beam, n cells across, clamped at z = 0.
class Beam {
 public:
  explicit Beam(int cells) : height_(2 * cells * half_plane_spacing(r)) {
    const int across = 2 * cells + 1, along = 2 * cells * lengths_of_height + 1;
    rest_ = test::fcc_box(across, across, along, r);
    base_ = half_plane_spacing(r) / 2;
    free_.assign(rest_.size(), -1);
    for (std::size_t i = 0; i < rest_.size(); ++i)
      if (!is_at(i, base_)) free_[i] = freedoms_++;
    assemble();
  }

  double height() const { return height_; }
  double length() const { return lengths_of_height * height_; }
  std::size_t particles() const { return rest_.size(); }

  /// Loads on particles, per(i) each, N; the resulting displacements, m.
  template <class Per>
  Vector displaced(const Per& per) const {
    Vector load = Vector::Zero(3 * freedoms_);
    for (std::size_t i = 0; i < rest_.size(); ++i)
      if (free_[i] >= 0) load.segment<3>(3 * free_[i]) = per(rest_[i], is_at(i, base_ + length()));
    return solve(load);
  }
  Vector solve(const Vector& load) const {
    return direct_ ? Vector(direct_->solve(load)) : Vector(iterative_->solve(load));
  }
  Eigen::Index freedoms() const { return 3 * freedoms_; }

  /// The mean over the end's particles of value(place at rest, displacement).
  template <class Value>
  double at_end(const Vector& u, const Value& value) const {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < rest_.size(); ++i)
      if (is_at(i, base_ + length())) {
        sum += value(rest_[i], Vec3(u.segment<3>(3 * free_[i])));
        count += 1;
      }
    return sum / count;
  }
  double count_at_end() const {
    return at_end(Vector::Zero(freedoms()), [](const Vec3&, const Vec3&) { return 1.0; }) *
           static_cast<double>(std::count_if(rest_.begin(), rest_.end(), [&](const Vec3& point) {
             return std::abs(point.z() - base_ - length()) < 1e-9;
           }));
  }

  /// Calls visit(place at rest, displacement) for the particles between two heights, in lengths.
  template <class Visit>
  void between(double low, double high, const Vector& u, const Visit& visit) const {
    for (std::size_t i = 0; i < rest_.size(); ++i) {
      const double fraction = (rest_[i].z() - base_) / length();
      if (fraction > low && fraction < high) visit(rest_[i], Vec3(u.segment<3>(3 * free_[i])));
    }
  }

 private:
  bool is_at(std::size_t i, double z) const { return std::abs(rest_[i].z() - z) < 1e-9; }

  void assemble() {
    const NeighborLists bonds = neighbors_within(rest_, rest_neighbor_range(r));
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](int row, int column, const Mat3& block) {
      if (row < 0 || column < 0) return;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) entries.emplace_back(3 * row + a, 3 * column + b, block(a, b));
    };
    for (std::size_t i = 0; i < rest_.size(); ++i)
      for (const std::uint32_t j : bonds.of(i)) {
        const Vec3 e = (rest_[i] - rest_[j]).normalized();
        const Mat3 block = stiffness * e * e.transpose();
        add(free_[i], free_[i], block);
        add(free_[i], free_[j], -block);
      }
    Matrix K(freedoms(), freedoms());
    K.setFromTriplets(entries.begin(), entries.end());
    matrix_ = K;
    if (rest_.size() <= max_solved_directly) {
      direct_ = std::make_unique<Direct>(matrix_);
    } else {
      iterative_ = std::make_unique<Iterative>(matrix_);
      iterative_->setTolerance(1e-9);
    }
  }

  double height_, base_ = 0;
  Points rest_;
  std::vector<int> free_;  ///< by particle: its place among those that move, or -1
  int freedoms_ = 0;
  Matrix matrix_;
  std::unique_ptr<Direct> direct_;
  std::unique_ptr<Iterative> iterative_;  ///< the direct one's memory grows faster than the beam
};

constexpr double d0 = 2 * r, k_over_d0 = stiffness / d0;
const CubicConstants C = fcc_constants();
const double E = C.young_modulus(Vec3::UnitZ()) * k_over_d0, G = C.C44 * k_over_d0;
constexpr double shear_coefficient = 5.0 / 6;

double moment_of_area(const Beam& beam) { return std::pow(beam.height(), 4) / 12; }
double area(const Beam& beam) { return beam.height() * beam.height(); }

/// Deflection under an end load of 1 N over Timoshenko's.
double end_load(const Beam& beam) {
  const double count = beam.count_at_end(), L = beam.length();
  const Vector u =
      beam.displaced([&](const Vec3&, bool end) { return Vec3(end ? 1 / count : 0, 0, 0); });
  const double found = beam.at_end(u, [](const Vec3&, const Vec3& by) { return by.x(); });
  return found /
         (L * L * L / (3 * E * moment_of_area(beam)) + L / (shear_coefficient * G * area(beam)));
}

/// Sag under its own weight, of 1 N per particle.
double own_weight(const Beam& beam) {
  const double weight = static_cast<double>(beam.particles()), L = beam.length();
  const Vector u = beam.displaced([](const Vec3&, bool) { return Vec3(1, 0, 0); });
  const double found = beam.at_end(u, [](const Vec3&, const Vec3& by) { return by.x(); });
  return found / (weight * L * L * L / (8 * E * moment_of_area(beam)) +
                  weight * L / (2 * shear_coefficient * G * area(beam)));
}

/// First frequency over Euler and Bernoulli's, lowered by shear and turning as Timoshenko's.
double first_frequency(const Beam& beam) {
  Vector shape = beam.displaced([](const Vec3&, bool end) { return Vec3(end, 0, 0); });
  double w2 = 0;
  for (int n = 0; n < 6; ++n) {  // inverse iteration, all masses alike
    const Vector next = beam.solve(mass * shape);
    w2 = shape.dot(shape) / shape.dot(next);
    shape = next.normalized();
  }
  const double L = beam.length(), per_length = mass * static_cast<double>(beam.particles()) / L;
  const double slender = 3.516 * std::sqrt(E * moment_of_area(beam) / per_length) / (L * L);
  const double gyration2 = beam.height() * beam.height() / 12 / (L * L);
  const double timoshenko =
      1 + gyration2 * (4.648 + 4.648 * E / (shear_coefficient * G));  // slopes of the first mode
  return std::sqrt(w2) / slender * std::sqrt(timoshenko);
}

/// Turn of the end under a moment of 1 N m, over that of a square bar of planes times spacing.
double torsion(const Beam& beam) {
  const double height = beam.height() + half_plane_spacing(r);
  const double polar = beam.at_end(Vector::Zero(beam.freedoms()), [](const Vec3& p, const Vec3&) {
    return p.x() * p.x() + p.y() * p.y();
  }) * beam.count_at_end();
  const Vector u = beam.displaced([&](const Vec3& p, bool end) {
    return end ? Vec3(-p.y(), p.x(), 0) / polar : Vec3(0, 0, 0);
  });
  const double found =
      beam.at_end(u,
                  [](const Vec3& p, const Vec3& by) { return p.x() * by.y() - p.y() * by.x(); }) *
      beam.count_at_end() / polar;
  return found / (beam.length() / (0.1406 * G * std::pow(height, 4)));
}

/// The slope of the line through points, by least squares.
class Slope {
 public:
  void add(double x, double y) { n_ += 1, x_ += x, y_ += y, xx_ += x * x, xy_ += x * y; }
  double value() const { return (n_ * xy_ - x_ * y_) / (n_ * xx_ - x_ * x_); }

 private:
  double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
};

/// Contraction across over stretch along, of the middle of a beam that is pulled.
double poisson_ratio(const Beam& beam) {
  const Vector u = beam.displaced([](const Vec3&, bool end) { return Vec3(0, 0, end); });
  Slope across, along;
  beam.between(0.3, 0.7, u, [&](const Vec3& place, const Vec3& by) {
    across.add(place.x(), by.x());
    along.add(place.z(), by.z());
  });
  return -across.value() / along.value();
}

/// Cells across.
std::array<int, 3> sizes_asked_for() {
  std::array<int, 3> sizes{2, 4, 6};
  if (const char* asked = std::getenv("SINEW_BEAM_CELLS"))
    std::sscanf(asked, "%d,%d,%d", &sizes[0], &sizes[1], &sizes[2]);
  return sizes;
}

/// The value at 1 / n = 0 of the parabola through three sizes.
double extrapolated(const std::array<int, 3>& n, const std::array<double, 3>& value) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    double weight = value[i];
    for (int j = 0; j < 3; ++j)
      if (j != i) weight *= (1.0 / n[j]) / (1.0 / n[j] - 1.0 / n[i]);
    sum += weight;
  }
  return sum;
}

TEST(Beam, ContractsAsThePoissonRatioAlongACubeAxisSays) {
  const std::array<int, 3> sizes = sizes_asked_for();
  std::array<double, 3> found;
  for (int n = 0; n < 3; ++n) found[n] = poisson_ratio(Beam(sizes[n]));
  EXPECT_NEAR(extrapolated(sizes, found), C.poisson_ratio(Vec3::UnitZ()), 0.01)
      << found[0] << ' ' << found[1] << ' ' << found[2];
}

TEST(Beam, BendsSagsSwingsAndTwistsAsTheorySays) {
  const std::array<int, 3> sizes = sizes_asked_for();
  std::array<std::array<double, 3>, 4> found;
  for (int n = 0; n < 3; ++n) {
    const Beam beam(sizes[n]);
    found[0][n] = end_load(beam);
    found[1][n] = own_weight(beam);
    found[2][n] = first_frequency(beam);
    found[3][n] = torsion(beam);
  }
  const char* names[] = {"end load", "own weight", "first frequency", "torsion"};
  for (int which = 0; which < 4; ++which) {
    EXPECT_NEAR(extrapolated(sizes, found[which]), 1, 0.03)
        << names[which] << ": " << found[which][0] << ' ' << found[which][1] << ' '
        << found[which][2];
  }
  for (int n = 0; n < 3; ++n) {  // for the shape that such a beam fills: a plane spacing wider
    const int planes = 2 * sizes[n] + 1;
    const double narrower = std::pow((planes - 1.0) / planes, 4);
    EXPECT_NEAR(narrower / found[0][n], 1 - lack_of_bending_stiffness(planes), 0.03) << planes;
  }
}

}  // namespace sinew::beam_test
