// SPDX-License-Identifier: GPL-3.0-or-later
// Which way faces point after cleaning.
#include <gtest/gtest.h>

#include <sinew/mesh/clean.h>
#include "mesh/shapes.h"
#include "mesh/surface_laws.h"

namespace sinew::orient_test {

using shapes::flipped;
using shapes::inverted;
using shapes::sphere;
using shapes::together;

/// Counts inward faces of a surface around the origin.
std::size_t inward_faces(const Surface& surface) {
  std::size_t count = 0;
  for (const auto& [a, b, c] : surface.triangles.faces) {
    const auto& points = surface.triangles.points;
    const Vec3 normal = (points[b] - points[a]).cross(points[c] - points[a]);
    count += normal.dot(points[a] + points[b] + points[c]) < 0;
  }
  return count;
}

double winding(const Surface& surface, const Vec3& at) {
  return laws::winding_number(surface.triangles, at);
}

std::size_t count_turned(const PolygonSoup& from, const PolygonSoup& to) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < from.polygons.size(); ++i)
    count += from.polygons[i] != to.polygons[i];
  return count;
}

TEST(Orient, TurnsBackWhatIsFlipped) {
  const auto body = sphere(1, 3);
  for (const double fraction : {0.01, 0.1, 0.3, 0.45}) {
    const auto mixed = flipped(body, fraction);
    const Surface surface = clean(mixed);
    EXPECT_EQ(inward_faces(surface), 0u) << fraction;
    EXPECT_EQ(surface.cleaning.faces_turned, count_turned(body, mixed)) << fraction;
    for (std::size_t i = 0; i < body.polygons.size(); ++i)
      EXPECT_EQ(surface.turned[i], body.polygons[i] != mixed.polygons[i]);
  }
}

TEST(Orient, FollowsMostOfTheAreaWhereThereIsNoInside) {
  auto sheet = shapes::sheet(4);
  for (const std::size_t face : {0, 1, 6})
    std::reverse(sheet.polygons[face].begin(), sheet.polygons[face].end());
  EXPECT_EQ(clean(sheet).cleaning.faces_turned, 6u);
  EXPECT_EQ(clean(inverted(sheet)).cleaning.faces_turned, 6u);
}

TEST(Orient, TurnsWhatIsInsideOut) {
  const auto body = sphere(1, 3);
  const Surface surface = clean(inverted(flipped(body, 0.1)));
  EXPECT_EQ(inward_faces(surface), 0u);
  EXPECT_EQ(surface.cleaning.faces_turned,
            body.polygons.size() - count_turned(body, flipped(body, 0.1)));
}

TEST(Orient, TellsTheOutsideOfOpenBodiesAndTheirIslands) {
  const auto body = sphere(1, 5);
  for (const double missing : {0.05, 0.2, 0.3, 0.4})
    for (const bool inside_out : {false, true}) {
      const auto torn = shapes::without(inside_out ? inverted(body) : body, missing);
      const Surface surface = clean(torn);
      EXPECT_EQ(inward_faces(surface), 0u) << missing << inside_out;
      EXPECT_EQ(surface.cleaning.faces_turned, inside_out ? torn.polygons.size() : 0);
    }
}

TEST(Orient, DoesNotTakeAHollowPieceForAPieceInsideOut) {
  for (const auto& body : {shapes::bumpy_ball(5), shapes::torus(1, 0.4)})
    for (const double missing : {0.1, 0.2, 0.3, 0.4}) {
      const auto torn = shapes::without(body, missing);
      EXPECT_EQ(clean(torn).cleaning.faces_turned, 0u) << missing;
      const Surface surface = clean(inverted(torn));
      EXPECT_EQ(surface.cleaning.faces_turned, surface.triangles.faces.size()) << missing;
    }
}

TEST(Orient, TellsTheOutsideOfASoup) {
  const auto soup = shapes::burst(sphere(1, 3), 0.9);
  for (const auto& given : {soup, inverted(soup)}) {
    const Surface surface = clean(given);
    EXPECT_EQ(surface.components, static_cast<int>(soup.polygons.size()));
    EXPECT_EQ(inward_faces(surface), 0u);
  }
}

TEST(Orient, DoesSoFarFromTheOrigin) {
  const Vec3 far(3e7, -2e7, 1e7);
  for (const auto& body : {sphere(1, 3), shapes::without(sphere(1, 3), 0.1)}) {
    const Surface surface = clean(shapes::moved(inverted(body), far));
    EXPECT_EQ(surface.cleaning.faces_turned, body.polygons.size());
  }
}

TEST(Orient, TurnsPartsThatOverlapEachByItself) {
  const auto a = sphere(1, 3), b = sphere(1, 3, Vec3(1, 0.1, 0.2));
  for (const auto& soup : {together(a, b), together(a, inverted(b)), together(inverted(a), b)}) {
    const Surface surface = clean(soup);
    EXPECT_NEAR(winding(surface, {-0.5, 0, 0}), 1, 1e-9);
    EXPECT_NEAR(winding(surface, {0.5, 0.05, 0.1}), 2, 1e-9);
    EXPECT_NEAR(winding(surface, {1.5, 0.1, 0.2}), 1, 1e-9);
    EXPECT_EQ(surface.components, 2);
  }
}

TEST(Orient, KeepsACavity) {
  const auto body = sphere(1, 3), hollow = inverted(sphere(0.5, 2));
  const auto shell = together(body, hollow);
  for (const auto& soup : {shell, inverted(shell), flipped(shell, 0.1), together(hollow, body)}) {
    const Surface surface = clean(soup);
    EXPECT_NEAR(winding(surface, {0.1, 0, 0}), 0, 1e-9);
    EXPECT_NEAR(winding(surface, {0.7, 0, 0}), 1, 1e-9);
  }
  EXPECT_EQ(clean(shell).cleaning.faces_turned, 0u);
}

TEST(Orient, KeepsACavityOfATornBody) {
  const auto shell = together(sphere(1, 4), inverted(sphere(0.5, 3)));
  for (const double missing : {0.01, 0.1, 0.2}) {
    const Surface surface = clean(inverted(shapes::without(shell, missing)));
    EXPECT_EQ(surface.cleaning.faces_turned, surface.triangles.faces.size());
  }
}

TEST(Orient, TakesABodyWithinABodyForABody) {
  const auto soup = together(sphere(1, 3), sphere(0.5, 2));
  for (const auto& given : {soup, inverted(soup)})
    EXPECT_NEAR(winding(clean(given), {0.1, 0, 0}), 2, 1e-9);
}

TEST(Orient, MakesEverySecondShellACavityWhereTheRuleSaysSo) {
  auto onion = sphere(1, 2);
  for (const double radius : {0.8, 0.6, 0.4}) onion = together(onion, sphere(radius, 2));
  const Surface surface = clean(flipped(onion, 0.1), {.rule = FillRule::hollow});
  for (const auto& [at, expected] : {std::pair(0.9, 1), {0.7, 0}, {0.5, 1}, {0.1, 0}})
    EXPECT_NEAR(winding(surface, {at, 0, 0}), expected, 1e-9) << at;
}

TEST(Orient, PutsABodyIntoACavity) {
  const auto soup =
      together(together(sphere(1, 3), inverted(sphere(0.8, 3))), sphere(0.3, 2, Vec3(0.2, 0, 0)));
  for (const auto& given : {soup, inverted(soup)}) {
    const Surface surface = clean(given);
    EXPECT_NEAR(winding(surface, {0.2, 0.01, 0.02}), 1, 1e-9);
    EXPECT_NEAR(winding(surface, {-0.4, 0, 0}), 0, 1e-9);
  }
}

TEST(Orient, SeesACavityThatTouchesItsWalls) {
  const auto body = shapes::box(Vec3::Zero(), Vec3(1, 1.1, 1.3));
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 low(corner & 1 ? 0.5 : 0, corner & 2 ? 0.6 : 0, corner & 4 ? 0.7 : 0);
    const Vec3 high = low + Vec3(0.5, 0.5, 0.6);
    const Surface surface = clean(together(body, inverted(shapes::box(low, high))));
    EXPECT_NEAR(winding(surface, low + Vec3(0.2, 0.3, 0.4)), 0, 1e-9);
    EXPECT_NEAR(winding(surface, Vec3(0.51, 0.58, 0.64)), 1, 1e-9);
  }
}

TEST(Orient, TellsThousandsOfCavities) {
  auto foam = shapes::box(Vec3::Zero(), Vec3::Constant(12));
  for (int i = 0; i < 1728; ++i)
    foam = together(std::move(foam),
                    inverted(sphere(0.4, 0, Vec3(i % 12 + 0.5, i / 12 % 12 + 0.5, i / 144 + 0.5))));
  const Surface surface = clean(inverted(foam));
  EXPECT_EQ(surface.components, 1729);
  EXPECT_EQ(surface.cleaning.faces_turned, surface.triangles.faces.size());
  EXPECT_NEAR(volume(surface.triangles), 1728 * (1 - 4.0 / 3 * 0.064), 1e-9);
}

TEST(Orient, DoesNotTakeANeighborInTheBoxOfATorusForACavity) {
  const auto soup = together(shapes::torus(1, 0.25), inverted(sphere(0.2, 2)));
  EXPECT_NEAR(winding(clean(soup), {0.05, 0, 0}), 1, 1e-9);
}

TEST(Orient, CutsAMoebiusStripAndAKleinBottle) {
  const Surface strip = clean(shapes::moebius_strip(24));
  EXPECT_EQ(strip.cleaning.edges_twisted, 2u);  // the shortest cut
  EXPECT_EQ(laws::border_with_caps(strip), 0u);
  const int n = 24, m = 12;
  PolygonSoup bottle = shapes::wrapped_grid(n, m, [&](int i, int j) {
    const double a = 2 * pi * i / n, b = 2 * pi * j / m;
    const double rho = 2 + std::cos(a / 2) * std::sin(b) - std::sin(a / 2) * std::sin(2 * b);
    return Vec3(rho * std::cos(a), rho * std::sin(a),
                std::sin(a / 2) * std::sin(b) + std::cos(a / 2) * std::sin(2 * b));
  });
  for (int j = 0; j < m; ++j)  // where i closes, j runs the other way
    bottle.polygons[(n - 1) * m + j] = {(n - 1) * m + j, (m - j) % m, (2 * m - j - 1) % m,
                                        (n - 1) * m + (j + 1) % m};
  const Surface surface = clean(bottle);
  EXPECT_GE(surface.cleaning.edges_twisted, static_cast<std::size_t>(m));
  EXPECT_LE(surface.cleaning.edges_twisted, 2u * m);
  EXPECT_EQ(laws::border_with_caps(surface), 0u);
}

TEST(Orient, TurnsBoxesThatShareAnEdge) {
  const auto box = shapes::box(Vec3::Zero(), Vec3::Ones());
  const auto other = shapes::box(Vec3(1, 1, 0), Vec3(2, 2, 1));
  for (const auto& soup : {together(box, other), together(box, inverted(other))}) {
    const Surface surface = clean(soup);
    EXPECT_DOUBLE_EQ(volume(surface.triangles), 2);
    EXPECT_EQ(surface.border.crowded_edges, 1u);
    EXPECT_TRUE(surface.closed());
    EXPECT_EQ(surface.components, 1);
  }
}

/// A box with a pit from its top, and a lid left over on the pit's rim.
PolygonSoup pit_with_a_lid() {
  PolygonSoup soup = shapes::box(Vec3::Zero(), Vec3(3, 3, 3));
  soup.polygons.erase(soup.polygons.begin() + 1);  // the top
  auto pit = inverted(shapes::box(Vec3(1, 1, 1), Vec3(2, 2, 3)));
  soup = together(soup, pit);  // the pit's own top is the lid
  for (const std::array<int, 4>& side :
       {std::array{4, 5, 13, 12}, {5, 7, 15, 13}, {7, 6, 14, 15}, {6, 4, 12, 14}})
    soup.polygons.emplace_back(side.begin(), side.end());
  return soup;
}

TEST(Orient, TurnsAPitAsItsBodyThoughALidCutsItOff) {
  for (const auto& soup : {pit_with_a_lid(), inverted(pit_with_a_lid())}) {
    const Surface surface = clean(soup);
    EXPECT_EQ(surface.border.crowded_edges, 4u);
    EXPECT_EQ(surface.border.edges, 4u);  // of the lid
    EXPECT_EQ(laws::border_with_caps(surface), 0u);
    EXPECT_NEAR(laws::capped_volume(surface), 25, 1e-9);
  }
}

TEST(Orient, LetsPiecesFollowTheirOwnBody) {
  auto finned = shapes::box(Vec3::Zero(), Vec3::Ones());
  finned.points.emplace_back(2, 2, 0.5);
  finned.polygons.push_back({3, 7, 8});  // at an edge of the box
  const auto large = sphere(3, 3, Vec3(9, 0, 0));
  const Surface surface = clean(together(inverted(finned), large));
  EXPECT_EQ(surface.cleaning.faces_turned, 13u);
  EXPECT_EQ(clean(together(finned, inverted(large))).cleaning.faces_turned, large.polygons.size());
}

}  // namespace sinew::orient_test
