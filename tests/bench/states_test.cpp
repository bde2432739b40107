// SPDX-License-Identifier: GPL-3.0-or-later
// The states on which stepping is timed are as their names say.
#include <gtest/gtest.h>
#include <algorithm>
#include <complex>

#include <sinew/core/cell_grid.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/core/triangles.h>

#include "bench/states.h"

namespace sinew::bench {
namespace {

constexpr std::size_t count = 3000;

/// Bonds of the undeformed packing, lengths in d0.
struct Bonds {
  double shortest = 1e9, longest = 0;
  double parted = 0;  ///< fraction of b or more
};

Bonds bonds_of(const Scene& scene, const Points& now) {
  const double b = scene.body.material.pair.b, d0 = nearest_distance(scene.start.radius);
  const auto lists = neighbors_within(scene_of(Condition::rest, count).body.rest, 1.1 * d0);
  Bonds bonds;
  for (std::size_t i = 0; i < now.size(); ++i)
    for (const auto j : lists.of(i)) {
      const double length = (now[i] - now[j]).norm();
      bonds.shortest = std::min(bonds.shortest, length / d0);
      bonds.longest = std::max(bonds.longest, length / d0);
      bonds.parted += length >= b;
    }
  bonds.parted /= static_cast<double>(lists.neighbor.size());
  return bonds;
}

/// |mean exp(i G x)|^2 for the packing's reflection 111: 1 for the packing at rest.
double order(const Points& points, double r) {
  const double cube = 2 * half_plane_spacing(r);
  const Vec3 G = 2 * pi / cube * Vec3(1, 1, 1);
  std::complex<double> sum = 0;
  for (const Vec3& point : points) sum += std::polar(1.0, G.dot(point));
  return std::norm(sum / static_cast<double>(points.size()));
}

TEST(States, HoldAboutTheParticlesAskedFor) {
  EXPECT_EQ(scene_of(Condition::rest, 3000).start.size(), 2965u);  // the paper's box
  for (const double asked : {3e4, 3e5})
    EXPECT_NEAR(static_cast<double>(
                    scene_of(Condition::rest, static_cast<std::size_t>(asked)).start.size()),
                asked, 0.03 * asked);
}

TEST(States, BonesKeepThemAsTheyAre) {
  for (const Condition condition :
       {Condition::rest, Condition::bent, Condition::twisted, Condition::crushed}) {
    const Scene scene = scene_of(condition, count);
    Forces forces;
    bone_forces(scene.start, scene.body, pose_at(scene.body.skeleton, scene.motion, 0), forces);
    const double bond = scene.body.material.stiffness() * scene.start.radius;
    for (const Vec3& force : forces.bone)
      EXPECT_LT(force.norm(), 1e-4 * bond) << name_of(condition);
  }
}

TEST(States, BentBodyTurnsByNinetyDegrees) {
  const Points box = scene_of(Condition::rest, count).body.rest;
  const Scene scene = scene_of(Condition::bent, count);
  const Vec3 before = box.back() - box[box.size() - 2];  // two of the last plane
  const Vec3 now = scene.start.position(box.size() - 1) - scene.start.position(box.size() - 2);
  EXPECT_LT((now - Eigen::AngleAxisd(pi / 2, Vec3::UnitY()) * before).norm(), 1e-12);
  const auto& bones = scene.body.skeleton.bones;
  EXPECT_NEAR(bones[0].axis().dot(bones[1].axis()), 0, 1e-12);
}

TEST(States, MapsStretchBondsModerately) {
  for (const Condition condition : {Condition::bent, Condition::twisted, Condition::crushed}) {
    const Scene scene = scene_of(condition, count);
    const Bonds bonds = bonds_of(scene, positions_of(scene.start));
    EXPECT_GT(bonds.shortest, 0.8) << name_of(condition);
    EXPECT_LT(bonds.longest, 1.25) << name_of(condition);  // neighbors to 1.3
  }
}

TEST(States, SettledBodiesKeepTheirBonds) {
  for (const Condition condition : {Condition::bent, Condition::twisted, Condition::crushed}) {
    const Scene scene = scene_of(condition, count);
    const Bonds bonds = bonds_of(scene, positions_of(settled(scene, condition)));
    EXPECT_GT(bonds.shortest, 0.8) << name_of(condition);
    EXPECT_EQ(bonds.parted, 0) << name_of(condition);
  }
}

TEST(States, CrushedBodyStaysCrushed) {
  const Scene scene = scene_of(Condition::crushed, count);
  const Box before = bounds(scene_of(Condition::rest, count).body.rest);
  const Box now = bounds(positions_of(settled(scene, Condition::crushed)));
  EXPECT_NEAR(now.sizes().x() / before.sizes().x(), 0.75, 0.03);
}

TEST(States, FlowedBodyHasNoLattice) {
  const Scene scene = scene_of(Condition::flowed, count);
  const double r = scene.start.radius;
  EXPECT_NEAR(order(scene.body.rest, r), 1, 1e-9);
  EXPECT_LT(order(positions_of(settled(scene, Condition::flowed)), r), 0.03);
}

TEST(States, DoNotDependOnTheNumberOfThreads) {
  const Scene scene = scene_of(Condition::flowed, count);
  std::uint64_t hash[2] = {};
  for (const int threads : {1, 2})
    with_threads(threads,
                 [&] { hash[threads - 1] = state_hash(settled(scene, Condition::flowed)); });
  EXPECT_EQ(hash[0], hash[1]);
}

}  // namespace
}  // namespace sinew::bench
