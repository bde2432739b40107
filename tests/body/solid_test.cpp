// SPDX-License-Identifier: GPL-3.0-or-later
// Bonds, volumes, cohesion: forces are the gradients of energies, conservation laws hold, and bonds
// break and creep as specified.
#include <sinew/body/solid.h>

#include <gtest/gtest.h>

#include <numbers>

#include "support/world.h"

namespace sinew::solid_test {

constexpr double r = 0.01;

Material material_of(MaterialModel model, double breaking_strain = 0) {
  MaterialOptions settings;
  settings.model = model;
  if (breaking_strain > 0) settings.breaking_strain = breaking_strain;
  return make_material(settings, {r, 1000 * volume_per_particle(r)});
}

Material without_cohesion() {
  MaterialOptions settings;
  settings.cohesion = Cohesion::initial_neighbors;
  return make_material(settings, {r, 1000 * volume_per_particle(r)});
}

const std::vector<Material>& materials() {
  static const std::vector<Material> all = {material_of(MaterialModel::bonded),
                                            material_of(MaterialModel::bonded_volume),
                                            without_cohesion()};
  return all;
}

Points shaken(Points points, double by, unsigned seed) {
  std::mt19937 random(seed);
  for (Vec3& point : points) point += by * test::random_vector(random);
  return points;
}

Points pair_forces_of(Solid& solid, const Material& material, const Points& at) {
  Forces forces;
  solid.forces(particles_at(at, r, material.mass), forces);
  return forces.pair;
}

double energy_of(Solid& solid, const Material& material, const Points& at) {
  return solid.energy(particles_at(at, r, material.mass));
}

TEST(Solid, IsAtRestAtRestAndWhereverItIsCarried) {
  const Points rest = test::fcc_box(5, 5, 9, r);
  for (const Material& material : {materials()[0], materials()[1]}) {
    Solid solid(material, rest);
    const Points carried = test::affine(rest, test::turned({1, 2, 3}, 100), Vec3(0.3, -0.2, 0.1));
    for (const Vec3& force : pair_forces_of(solid, material, carried))
      EXPECT_LT(force.norm(), 1e-12 * material.pair.k1 * r * r);
    EXPECT_LT(energy_of(solid, material, carried), 1e-20);
  }
}

TEST(Solid, OfAFeatherPushesAsOneOfSteel) {
  const Points rest = test::fcc_box(5, 5, 7, r);
  const Points at = shaken(rest, 0.3 * r, 3);
  for (const Material& material : materials()) {
    Material soft = material;
    const double factor = 1e-9;
    for (double* stiffness : {&soft.pair.k1, &soft.pair.k2, &soft.bond.stiffness, &soft.bond.second,
                              &soft.volume_stiffness})
      *stiffness *= factor;
    Solid solid(material, rest), feather(soft, rest);
    const Points stiff_forces = pair_forces_of(solid, material, at);
    const Points soft_forces = pair_forces_of(feather, soft, at);
    for (std::size_t i = 0; i < rest.size(); ++i)
      EXPECT_LT((soft_forces[i] - factor * stiff_forces[i]).norm(),
                1e-12 * factor * material.pair.k1 * r * r);
  }
}

TEST(Solid, ForcesAreTheSlopesOfItsEnergy) {
  const Points rest = test::fcc_box(5, 5, 7, r);
  for (const Material& material : materials()) {
    Solid solid(material, rest);
    const Mat3 F =
        Mat3(Mat3::Identity()) + 0.2 * (Mat3() << 1, .5, 0, -.3, -1, .2, 0, .4, .5).finished();
    const Points at = shaken(test::affine(rest, F), 0.3 * r, 7);
    const Points forces = pair_forces_of(solid, material, at);
    const double h = 1e-6 * r, scale = material.pair.k1 * r * r;
    for (std::size_t i = 0; i < rest.size(); i += 5)
      for (int axis = 0; axis < 3; ++axis) {
        Points ahead = at, behind = at;
        ahead[i][axis] += h;
        behind[i][axis] -= h;
        const double slope =
            (energy_of(solid, material, ahead) - energy_of(solid, material, behind)) / (2 * h);
        EXPECT_NEAR(forces[i][axis], -slope, 1e-5 * scale);
      }
  }
}

TEST(Solid, KeepsMomentumAndAngularMomentum) {
  const Points rest = test::fcc_box(5, 5, 9, r);
  for (const Material& material : materials()) {
    Solid solid(material, rest);
    const Points at = shaken(rest, r, 3);
    const Points forces = pair_forces_of(solid, material, at);
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    double size = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      sum += forces[i];
      moment += at[i].cross(forces[i]);
      size += forces[i].norm();
    }
    EXPECT_LT(sum.norm(), 1e-13 * size);
    EXPECT_LT(moment.norm(), 1e-13 * size);
  }
}

TEST(Solid, OnlyNeighborsAtRestAttractWithoutCohesion) {
  // Two blocks that approach to contact: gap of 2.3 r between the nearest, within the paper's
  // attraction.
  const Points block = test::fcc_box(3, 3, 3, r);
  Points rest = block, touching = block;
  for (const Vec3& point : block) {
    rest.push_back(point + Vec3(0.2, 0, 0));
    touching.push_back(point + Vec3(2 * half_plane_spacing(r) + 2.3 * r, 0, 0));
  }
  const auto push_apart = [&](const Material& material, const Points& at) {
    Solid solid(material, rest);
    const Points forces = pair_forces_of(solid, material, at);
    double along = 0;
    for (std::size_t i = 0; i < block.size(); ++i) along -= forces[i].x();
    return along;
  };
  Forces sticking;
  const Material paper = material_of(MaterialModel::paper);
  pair_forces(particles_at(touching, r, paper.mass), paper, sticking);
  double along = 0;
  for (std::size_t i = 0; i < block.size(); ++i) along -= sticking.pair[i].x();
  EXPECT_LT(along, -1e-3 * paper.pair.k1 * r * r);  // the paper's blocks pull
  for (const Material& material : materials()) {
    EXPECT_NEAR(push_apart(material, touching), 0, 1e-12 * paper.pair.k1 * r * r);
    Points pressed = touching;
    for (std::size_t i = block.size(); i < pressed.size(); ++i) pressed[i].x() -= 0.5 * r;
    EXPECT_GT(push_apart(material, pressed), 1e-3 * paper.pair.k1 * r * r);
  }
}

TEST(Solid, BodiesThatDoNotTouchDoNotDragEachOther) {
  const Points block = test::fcc_box(3, 3, 3, r);
  for (const double gap : {1.98, 2.02, 2.3}) {  // in radii, between the nearest
    Points rest = block;
    for (const Vec3& point : block)
      rest.push_back(point + Vec3(0, 0, 2 * half_plane_spacing(r) + gap * r));
    for (Material material : materials())
      for (const auto form : {DampingForm::paper, DampingForm::symmetric, DampingForm::central}) {
        material.damping_form = form;
        Points apart = rest;  // neighbors at rest are those of the block alone
        for (std::size_t i = block.size(); i < apart.size(); ++i) apart[i].z() += r;
        Solid solid(material, apart);
        Particles particles = particles_at(rest, r, material.mass);
        for (std::size_t i = block.size(); i < rest.size(); ++i)
          particles.set_velocity(i, Vec3(0.1, 0, 0.3));
        Forces forces;
        solid.forces(particles, forces);
        double drag = 0;
        for (const Vec3& force : forces.damping) drag += force.norm();
        if (gap < 2)
          EXPECT_GT(drag, 1e-3 * material.damping);
        else
          EXPECT_LT(drag, 1e-12 * material.damping);
      }
  }
}

TEST(Solid, CountsBondedAndTouchingParticlesAsNeighbors) {
  const Points rest = test::fcc_box(5, 5, 5, r);
  for (const Material& material : materials()) {
    Solid solid(material, rest);
    Forces forces;
    // At 1.2 times the size no one touches, but bonds hold; the paper's attraction ends at 1.3.
    solid.forces(particles_at(test::affine(rest, 1.2 * Mat3::Identity()), r, material.mass),
                 forces);
    EXPECT_EQ(*std::max_element(forces.neighbors.begin(), forces.neighbors.end()), 12);
    // At 0.7 times the size, six second neighbors touch as well.
    solid.forces(particles_at(test::affine(rest, 0.7 * Mat3::Identity()), r, material.mass),
                 forces);
    EXPECT_EQ(*std::max_element(forces.neighbors.begin(), forces.neighbors.end()), 18);
  }
}

TEST(Bonds, BreakBeyondTheirStrainAndReportTheEnergy) {
  const Points rest = test::fcc_box(3, 3, 9, r);
  for (const auto model : {MaterialModel::bonded, MaterialModel::bonded_volume}) {
    const Material material = material_of(model, 0.1);
    Solid solid(material, rest);
    const double middle = rest.back().z() / 2;
    Points torn = shaken(rest, 0.05 * r, 4);
    for (Vec3& point : torn)
      if (point.z() > middle) point.z() += 0.5 * r;
    const Particles particles = particles_at(torn, r, material.mass);
    Forces forces;
    solid.forces(particles, forces);
    const double before = solid.energy(particles);
    const double lost = solid.evolve(particles, 1e-3);
    EXPECT_GT(lost, 0);
    EXPECT_NEAR(before - solid.energy(particles), lost, 1e-12 * before);
    int broken = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      broken += solid.bonds().nearest.broken[i];
      int lacking = 0;
      for (std::size_t j = 0; j < rest.size(); ++j) {
        const auto other = static_cast<std::uint32_t>(j);
        const bool were_neighbors = i != j && (rest[i] - rest[j]).norm() < 2.2 * r;
        lacking += were_neighbors && !solid.bonds().nearest.bonded(i, other);
        EXPECT_EQ(solid.bonds().nearest.bonded(i, other),
                  solid.bonds().nearest.bonded(j, static_cast<std::uint32_t>(i)));
      }
      EXPECT_EQ(lacking, solid.bonds().nearest.broken[i]);
    }
    EXPECT_GT(broken, 0);
    EXPECT_EQ(solid.evolve(particles, 1e-3), 0);  // nothing more breaks where nothing moved
  }
}

/// The energy of all bonds across a plane when they break, by counting them, over its area.
double energy_of_crack(const Material& material, const Vec3& normal, double radius) {
  const Points rest = test::fcc_ball(25, radius);
  const SolidBonds bonds = make_bonds(rest, test::neighbors(rest, material).all(), material);
  const double width = 15 * radius;  // of a disk far from the surface
  double sum = 0;
  for (const Bonds* some : {&bonds.nearest, &bonds.second})
    for (std::size_t i = 0; i < rest.size(); ++i)
      for (std::uint32_t e = some->neighbors.first[i]; e < some->neighbors.first[i + 1]; ++e) {
        const Vec3 &from = rest[i], &to = rest[some->neighbors.neighbor[e]];
        const double below = from.dot(normal) - 0.3 * radius, above = to.dot(normal) - 0.3 * radius;
        if (!(below < 0 && above >= 0)) continue;
        const Vec3 cut = from + (to - from) * (below / (below - above));
        const double stretched = material.bond.breaking_strain * some->rest_length[e];
        if (cut.norm() < width) sum += some->stiffness[e] / 2 * stretched * stretched;
      }
  return sum / (std::numbers::pi * (width * width - 0.09 * radius * radius));
}

TEST(Bonds, BreakWithTheFractureEnergyPerAreaWhateverTheRadius) {
  std::mt19937 random(5);
  for (const bool isotropic : {true, false})
    for (const double radius : {0.01, 0.0025}) {
      MaterialOptions options;
      options.model = MaterialModel::bonded;
      options.isotropic = isotropic;
      options.fracture_energy = 3;
      const Material material =
          make_material(options, {radius, 1000 * volume_per_particle(radius)});
      double mean = 0;
      constexpr int planes = 20;
      for (int k = 0; k < planes; ++k)
        mean +=
            energy_of_crack(material, test::random_vector(random).normalized(), radius) / planes;
      EXPECT_NEAR(mean, 3, 0.1);
    }
}

MaterialOptions yielding(double strain, double rate) {
  MaterialOptions options;
  options.model = MaterialModel::bonded;
  options.yield_strain = strain;
  options.creep_rate = rate;
  return options;
}

/// The particle in the middle of a box or a ball.
std::size_t innermost(const Points& points) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& point : points) middle += point / double(points.size());
  const auto nearer = [&](const Vec3& a, const Vec3& b) {
    return (a - middle).norm() < (b - middle).norm();
  };
  return static_cast<std::size_t>(std::min_element(points.begin(), points.end(), nearer) -
                                  points.begin());
}

/// Rest lengths over those of a body that is deformed like that for a time (s).
std::vector<double> crept(const MaterialOptions& options, const Points& rest, const Mat3& F,
                          double time) {
  const Material material = make_material(options, {r, 1000 * volume_per_particle(r)});
  Solid solid(material, rest);
  const std::vector<double> before = solid.rest_lengths();
  const Particles particles = particles_at(test::affine(rest, F), r, material.mass);
  const double energy = solid.energy(particles);
  double lost = 0;
  for (int step = 0; step < 1000; ++step) lost += solid.evolve(particles, time / 1000);
  EXPECT_NEAR(energy - solid.energy(particles), lost, 1e-12 * energy);
  EXPECT_GE(lost, 0);
  std::vector<double> ratios = solid.rest_lengths();
  for (std::size_t e = 0; e < ratios.size(); ++e) ratios[e] /= before[e];
  return ratios;
}

TEST(Flow, LeavesPressureAlone) {
  for (const double scale : {0.8, 1.1})
    for (const double ratio :
         crept(yielding(0.001, 100), test::fcc_ball(5, r), scale * Mat3::Identity(), 1))
      EXPECT_NEAR(ratio, 1, 1e-12);
}

TEST(Flow, BeginsAtTheYieldStrainOfABarThatIsPulled) {
  const Points rest = test::fcc_box(9, 9, 9, r);
  for (const Mat3& turn : {Mat3(Mat3::Identity()), test::turned({1, 2, 3}, 40)})
    for (const double strain : {0.00099, 0.00103}) {
      const Mat3 pulled = turn * Vec3(-0.25, -0.25, 1).asDiagonal() * turn.transpose();
      const auto ratios = crept(yielding(0.001, 1), rest, Mat3::Identity() + strain * pulled, 0.1);
      const NeighborLists near = neighbors_within(rest, rest_neighbor_range(r));
      const std::size_t inner = innermost(rest);
      const auto [least, most] = std::minmax_element(ratios.begin() + near.first[inner],
                                                     ratios.begin() + near.first[inner + 1]);
      if (strain < 0.001)
        EXPECT_LT(*most - *least, 1e-12);
      else
        EXPECT_GT(*most - *least, 1e-6);
    }
}

/// Bingham's solid: a deviator that grows by sqrt(3/2) times the rate of strain, and decays by the
/// creep rate towards the yield shear.
TEST(Flow, OfASteadyPullExceedsTheYieldShearByItsRateOverTheCreepRate) {
  const Points rest = test::fcc_box(9, 9, 9, r);
  const double yield = 1e-3, creep_rate = 120, rate = 0.01, step = 1e-4;
  const Material material =
      make_material(yielding(yield, creep_rate), {r, 1000 * volume_per_particle(r)});
  Solid solid(material, rest);
  const Mat3 pull = Vec3(-0.5, -0.5, 1).asDiagonal();
  Points now;
  for (int k = 1; k <= 2000; ++k) {
    now = test::affine(rest, Mat3::Identity() + rate * step * k * pull);
    solid.evolve(particles_at(now, r, material.mass), step);
  }
  const double shear = yield_shear(yield, 0.25) + std::sqrt(1.5) * rate / creep_rate;
  const std::vector<double> lengths = solid.rest_lengths();
  const NeighborLists near = neighbors_within(rest, rest_neighbor_range(r));
  const std::size_t inner = innermost(rest);
  for (std::uint32_t e = near.first[inner]; e < near.first[inner + 1]; ++e) {
    const Vec3 n = (rest[near.neighbor[e]] - rest[inner]).normalized();
    const double elastic = (now[near.neighbor[e]] - now[inner]).norm() / lengths[e] - 1;
    EXPECT_NEAR(elastic, shear / std::sqrt(1.5) * n.dot(pull * n), 0.01 * shear);
  }
}

/// Within, rest lengths change by n D n of a strain D without trace, which decays towards the yield
/// strain at the creep rate.
TEST(Flow, DecaysShearToTheYieldStrainAndKeepsTheVolume) {
  const Points rest = test::fcc_box(9, 9, 9, r);
  const double strain = 1e-3, yield = 2e-4, rate = 3;
  const Mat3 deviator = strain * Vec3(-0.5, -0.5, 1).asDiagonal();
  const Mat3 F = Mat3::Identity() * 1.0005 + deviator;
  const auto ratios = crept(yielding(yield, rate), rest, F, 1);
  // Pulled bars have the deviator (1 + nu) 2/3 of their strain along them.
  const double least = yield * 1.25 * 2 / 3, flowed = (strain - least) * (1 - std::exp(-rate));
  const NeighborLists near = neighbors_within(rest, rest_neighbor_range(r));
  const std::size_t inner = innermost(rest);
  double sum = 0;
  for (std::uint32_t e = near.first[inner]; e < near.first[inner + 1]; ++e) {
    const Vec3 n = (rest[near.neighbor[e]] - rest[inner]).normalized();
    EXPECT_NEAR(ratios[e] - 1, flowed / strain * n.dot(deviator * n), 0.01 * flowed);
    sum += ratios[e] - 1;
  }
  EXPECT_LT(std::abs(sum) / 12, 0.002 * flowed);
}

}  // namespace sinew::solid_test
