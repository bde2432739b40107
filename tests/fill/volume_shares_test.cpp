// SPDX-License-Identifier: GPL-3.0-or-later
// How much of the body each particle stands for.
#include <gtest/gtest.h>
#include <array>
#include <map>
#include <numeric>

#include <sinew/core/particles.h>
#include <sinew/core/triangles.h>
#include <sinew/fill/pack.h>
#include <sinew/repair/read_surface.h>
#include "mesh/mesh_files.h"
#include "support/source_dir.h"

namespace sinew::volume_shares_test {

constexpr double radius = 0.008;

Surface creature() {
  return read_surface(mesh_files::body_at(test::source_dir() + "/data/meshes/creature.ply"));
}

PackOptions with_volume_shares() {
  PackOptions options;
  options.radius = radius;
  options.volume_shares = true;
  return options;
}

/// The same body seen in other axes.
Surface moved(Surface surface, const Mat3& by) {
  for (Vec3& point : surface.triangles.points) point = by * point;
  if (by.determinant() < 0)
    for (auto& face : surface.triangles.faces) std::swap(face[1], face[2]);
  return surface;
}

using Place = std::array<std::int64_t, 3>;

std::map<Place, double> by_place(const Filling& filling, const Mat3& back) {
  std::map<Place, double> volume_shares;
  for (std::size_t i = 0; i < filling.particles.size(); ++i) {
    const Vec3 at = back * filling.particles.position(i) / (0.01 * radius);
    volume_shares[{std::llround(at.x()), std::llround(at.y()), std::llround(at.z())}] =
        filling.volume_share[i];
  }
  return volume_shares;
}

TEST(VolumeShares, SumToTheVolumeAndKeepItsCenter) {
  const Surface surface = creature();
  const Filling filling = pack(surface, with_volume_shares());
  const double sum = std::accumulate(filling.volume_share.begin(), filling.volume_share.end(), 0.0);
  const double whole = volume(surface.triangles) / volume_per_particle(radius);
  EXPECT_NEAR(sum, whole, 0.01 * whole);
  Vec3 center = Vec3::Zero(), of_mesh = Vec3::Zero();
  for (std::size_t i = 0; i < filling.volume_share.size(); ++i)
    center += filling.volume_share[i] / sum * filling.particles.position(i);
  double volume = 0;
  for (const auto& [a, b, c] : surface.triangles.faces) {
    const auto& p = surface.triangles.points;
    const double part = p[a].dot(p[b].cross(p[c])) / 6;
    of_mesh += part / 4 * (p[a] + p[b] + p[c]);
    volume += part;
  }
  EXPECT_LT((center - of_mesh / volume).norm(), 0.05 * radius);
}

TEST(VolumeShares, AreThoseOfTheBodyTurnedOrMirroredInItsLattice) {
  const Surface surface = creature();
  const auto as_it_is = by_place(pack(surface, with_volume_shares()), Mat3::Identity());
  const Mat3 mirror = Vec3(1, -1, 1).asDiagonal();
  const Mat3 turn = (Mat3() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished();
  const Mat3 cycle = (Mat3() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished();
  for (const Mat3& by : {mirror, turn, cycle}) {
    const auto other = by_place(pack(moved(surface, by), with_volume_shares()), by.transpose());
    ASSERT_EQ(other.size(), as_it_is.size());
    for (const auto& [place, volume_share] : as_it_is) {
      ASSERT_TRUE(other.contains(place));
      EXPECT_NEAR(other.at(place), volume_share, 1e-9);
    }
  }
}

}  // namespace sinew::volume_shares_test
