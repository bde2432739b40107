// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/repair/repair.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <sinew/core/error.h>
#include <sinew/mesh/border.h>
#include "mesh/shapes.h"

namespace sinew::repair_test {

Triangles triangles_of(const PolygonSoup& soup) {
  Triangles triangles{soup.points, {}};
  for (const auto& f : soup.polygons)
    for (std::size_t i = 2; i < f.size(); ++i) triangles.faces.push_back({f[0], f[i - 1], f[i]});
  return triangles;
}

/// Counts edges along which faces do not go as often one way as the other.
std::size_t open_edges(const Triangles& triangles) {
  std::size_t open = 0;
  const auto uses = edge_uses(triangles);
  for_each_edge(uses, [&](std::span<const EdgeUse> use) {
    open += use[0].low != use[0].high && net_count(use) != 0;
  });
  return open;
}

/// No side is left open, and what was there keeps its place.
HoleClosing expect_closed(const Triangles& open) {
  const HoleClosing closing = close_holes(open);
  EXPECT_EQ(open_edges(closing.triangles), 0u);
  EXPECT_EQ(closing.triangles.points, open.points);
  EXPECT_EQ(closing.triangles.faces.size(), open.faces.size() + closing.faces_added);
  EXPECT_TRUE(std::equal(open.faces.begin(), open.faces.end(), closing.triangles.faces.begin()));
  return closing;
}

/// Without each face that chance hits.
Triangles with_missing(Triangles triangles, double fraction, unsigned seed) {
  std::mt19937 random(seed);
  std::erase_if(triangles.faces, [&](const auto&) { return random() < fraction * 4294967296.0; });
  return triangles;
}

std::size_t doubled_faces(const Triangles& triangles) {
  auto faces = triangles.faces;
  for (auto& face : faces) std::sort(face.begin(), face.end());
  std::sort(faces.begin(), faces.end());
  return faces.end() - std::unique(faces.begin(), faces.end());
}

Triangles open_box() {
  Triangles box = triangles_of(shapes::box(Vec3::Zero(), Vec3::Ones()));
  box.faces.resize(10);
  return box;
}

/// A tube along z whose rims swing by `swing`, open at both ends.
Triangles tube(int n, double swing) {
  Triangles tube;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * pi * i / n;
    tube.points.emplace_back(std::cos(a), std::sin(a), swing * std::sin(5 * a));
    tube.points.emplace_back(std::cos(a), std::sin(a), 2 + swing * std::sin(3 * a));
    const int at = 2 * i, next = 2 * ((i + 1) % n);
    tube.faces.push_back({at, next, next + 1});
    tube.faces.push_back({at, next + 1, at + 1});
  }
  return tube;
}

TEST(CloseHoles, LeavesAClosedSurfaceAsItIs) {
  const Triangles ball = triangles_of(shapes::sphere(1, 3));
  const HoleClosing closing = expect_closed(ball);
  EXPECT_EQ(closing.holes_closed, 0u);
  EXPECT_EQ(closing.faces_added, 0u);
}

TEST(CloseHoles, AddsAsManyFacesAsAreMissing) {
  const Triangles ball = triangles_of(shapes::sphere(1, 4));
  const Triangles open = with_missing(ball, 0.05, 9);
  EXPECT_EQ(expect_closed(open).faces_added, ball.faces.size() - open.faces.size());
}

TEST(CloseHoles, GivesABallItsVolumeBack) {
  const Triangles ball = triangles_of(shapes::sphere(1, 5));
  for (const double fraction : {0.05, 0.2, 0.4}) {
    const Triangles open = with_missing(ball, fraction, 7);
    const HoleClosing closing = expect_closed(open);
    EXPECT_NEAR(volume(closing.triangles) / volume(ball), 1, 1e-3);
    EXPECT_NEAR(area(closing.triangles) / area(ball), 1, 1e-2);
  }
}

/// Holes around an island go across it, not around: else it would get a second side.
TEST(CloseHoles, CoversNoFaceASecondTime) {
  const Triangles ball = triangles_of(shapes::sphere(1, 5));
  for (unsigned seed = 0; seed < 5; ++seed)
    EXPECT_EQ(doubled_faces(close_holes(with_missing(ball, 0.3, seed)).triangles), 0u);
}

TEST(CloseHoles, PutsALidOnABox) {
  const HoleClosing closing = expect_closed(open_box());
  EXPECT_EQ(closing.holes_closed, 1u);
  EXPECT_EQ(closing.faces_added, 2u);
  EXPECT_DOUBLE_EQ(volume(closing.triangles), 1);
}

TEST(CloseHoles, ClosesHolesOfAnySize) {
  for (const int n : {3, 4, 50, 999, 1001, 5000, 100000}) {
    const HoleClosing closing = expect_closed(tube(n, 0));
    EXPECT_EQ(closing.holes_closed, 2u);
    EXPECT_EQ(closing.faces_added, 2u * (n - 2));
    EXPECT_NEAR(volume(closing.triangles), n * std::sin(2 * pi / n), 1e-9);
  }
}

TEST(CloseHoles, ClosesHolesThatAreNotFlat) {
  for (const int n : {20, 200, 3000}) expect_closed(tube(n, 0.5));
}

/// Two boxes without lids that touch at one corner of their rims.
TEST(CloseHoles, KeepsHolesThatTouchApart) {
  const auto box = [](double x, double y) {
    auto soup = shapes::box({x, y, 0}, {x + 1, y + 1, 1});
    soup.polygons.erase(soup.polygons.begin() + 1);  // the one at z = 1
    return soup;
  };
  Triangles boxes = triangles_of(shapes::together(box(0, 0), box(1, 1)));
  for (auto& face : boxes.faces)
    for (int& corner : face)
      if (corner == 12) corner = 7;
  const HoleClosing closing = expect_closed(boxes);
  EXPECT_NEAR(volume(closing.triangles), 2, 1e-12);
  EXPECT_NEAR(area(closing.triangles), 12, 1e-12);
}

TEST(CloseHoles, TakesWhatIsNoBody) {
  const Triangles tetrahedron = triangles_of(shapes::tetrahedron());
  const Points& points = tetrahedron.points;
  expect_closed({});
  expect_closed({points, {}});
  expect_closed({points, {{0, 1, 2}}});                        // one face
  expect_closed({points, {{0, 1, 2}, {0, 1, 2}}});             // doubled
  expect_closed({points, {{0, 1, 2}, {0, 2, 1}}});             // both sides
  expect_closed({points, {{0, 1, 1}, {2, 2, 2}, {3, 0, 1}}});  // collapsed
  expect_closed({points, {{0, 1, 2}, {0, 1, 3}}});             // twisted
  expect_closed({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {{0, 1, 2}, {0, 2, 3}}});  // a line
  expect_closed({Points(5, Vec3::Ones()), {{0, 1, 2}, {2, 3, 4}}});                       // a point
  Triangles fan = tetrahedron;
  fan.faces = {{0, 1, 2}, {1, 0, 3}, {0, 1, 3}, {1, 0, 2}, {0, 1, 3}};  // five at an edge
  expect_closed(fan);
}

TEST(CloseHoles, ClosesTheBorderOfAMoebiusStrip) {
  Triangles strip;
  const int n = 40;
  for (int i = 0; i < n; ++i)
    for (const double side : {-0.3, 0.3}) {
      const double a = 2 * pi * i / n, rho = 1 + side * std::cos(a / 2);
      strip.points.emplace_back(rho * std::cos(a), rho * std::sin(a), side * std::sin(a / 2));
    }
  for (int i = 0; i < n; ++i) {
    const int a = 2 * i, b = a + 1, c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
    strip.faces.insert(strip.faces.end(), {{a, c, d}, {a, d, b}});
  }
  expect_closed(strip);
}

TEST(CloseHoles, ClosesAnyFacesAtAll) {
  std::mt19937 random(11);
  const auto below = [&](int n) { return static_cast<int>(random() % n); };
  for (int i = 0; i < 3000; ++i) {
    Triangles any;
    const int points = 1 + below(12), grid = 1 + below(4);  // few places: many points coincide
    for (int n = 0; n < points; ++n) any.points.emplace_back(below(grid), below(grid), below(grid));
    for (int n = below(30); n >= 0; --n)
      any.faces.push_back({below(points), below(points), below(points)});
    expect_closed(any);
  }
}

/// Every edge has two faces, in both directions.
void expect_skin(const Triangles& skin) {
  const auto uses = edge_uses(skin);
  for_each_edge(uses, [](std::span<const EdgeUse> use) {
    ASSERT_EQ(use.size(), 2u);
    ASSERT_NE(use[0].forward, use[1].forward);
  });
  EXPECT_GT(volume(skin), 0);
}

TEST(Wrap, LiesAThirtiethOutsideOfABall) {
  const Triangles ball = triangles_of(shapes::sphere(1, 4));
  const double alpha = 0.15;
  const Triangles skin = wrap(ball, alpha);
  expect_skin(skin);
  for (const Vec3& point : skin.points) ASSERT_NEAR(point.norm(), 1 + alpha / 30, 0.005);
  EXPECT_NEAR(volume(skin) / volume(ball), 1 + 3 * alpha / 30, 0.01);
}

TEST(Wrap, DoesNotSeeGapsNarrowerThanItself) {
  const Triangles ball = with_missing(triangles_of(shapes::sphere(1, 4)), 0.05, 3);
  const Triangles skin = wrap(ball, 0.3);
  expect_skin(skin);
  EXPECT_NEAR(volume(skin), 4 * pi / 3, 0.15);
  EXPECT_GT(volume(wrap(open_box(), 1.2)), 1);
}

TEST(Wrap, ClosesASoupOfTriangles) {
  std::mt19937 random(5);
  const auto place = [&](double size) {
    const double x = random() * size / 4294967296.0, y = random() * size / 4294967296.0;
    return Vec3(x, y, random() * size / 4294967296.0);
  };
  Triangles soup;
  for (int i = 0; i < 900; i += 3) {
    const Vec3 at = place(1);
    for (int j = 0; j < 3; ++j) soup.points.push_back(at + place(0.2));
    soup.faces.push_back({i, i + 1, i + 2});
  }
  const Triangles skin = wrap(soup, 0.2);
  expect_skin(skin);
  const Box box = bounds(skin.points);
  for (const Vec3& point : soup.points) EXPECT_TRUE(box.contains(point));
}

TEST(Wrap, TakesDoubledCollapsedAndCrowdedFaces) {
  Triangles ball = triangles_of(shapes::sphere(1, 2));
  const double once = volume(wrap(ball, 0.3));
  const auto faces = ball.faces;
  for (const auto& [a, b, c] : faces) {
    ball.faces.push_back({c, b, a});
    ball.faces.push_back({a, a, b});
  }
  ball.points.push_back(Vec3::Zero());
  ball.faces.push_back({0, 2, static_cast<int>(ball.points.size()) - 1});
  EXPECT_NEAR(volume(wrap(ball, 0.3)) / once, 1, 0.01);
}

TEST(Wrap, KnowsNoOriginAndNoSize) {
  const Triangles ball = triangles_of(shapes::sphere(1, 3));
  const double fraction = volume(wrap(ball, 0.3)) / volume(ball);
  for (const double scale : {1e-9, 1e9}) {
    Triangles other = ball;
    for (Vec3& point : other.points) point = scale * (point + Vec3(1000, -2000, 500));
    EXPECT_NEAR(volume(wrap(other, 0.3 * scale)) / volume(other), fraction, 0.01);
  }
}

std::string refusal(const Triangles& surface, double alpha) {
  try {
    wrap(surface, alpha);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::bad_input);
    return error.what();
  }
  return "none";
}

TEST(Wrap, RefusesALengthThatFitsNot) {
  const Triangles ball = triangles_of(shapes::sphere(1, 4));
  for (const double alpha : {0.0, -1.0, 4.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_NE(refusal(ball, alpha).find("fits no mesh of a diagonal of 3.46 m; "),
              std::string::npos)
        << refusal(ball, alpha);
  EXPECT_EQ(
      refusal(ball, 0.001),
      "a wrap at 0.001 m takes about 30 million faces, more than 1 million; give 0.00553 m or "
      "more");
}

TEST(Wrap, RefusesWhatHasNoArea) {
  EXPECT_NE(refusal({}, 1).find("no face with an area"), std::string::npos);
  EXPECT_NE(refusal({Points(3, Vec3::Ones()), {{0, 1, 2}}}, 1).find("no face with an area"),
            std::string::npos);
}

TEST(Wrap, RefusesALeak) {
  EXPECT_NE(refusal(open_box(), 0.2).find("leaks through a hole"), std::string::npos);
  Triangles sheet = open_box();
  sheet.faces.resize(2);
  EXPECT_NE(refusal(sheet, 0.1).find("little more than the film"), std::string::npos);
}

}  // namespace sinew::repair_test
