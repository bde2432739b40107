// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies with a known inside, for the tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include <sinew/core/triangles.h>
#include <sinew/core/vector.h>

namespace sinew::shapes {

/// The polygons as fans of triangles.
inline Triangles triangles_of(const PolygonSoup& soup) {
  Triangles triangles{soup.points, {}};
  for (const auto& polygon : soup.polygons)
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      triangles.faces.push_back({polygon[0], polygon[i], polygon[i + 1]});
  return triangles;
}

inline PolygonSoup tetrahedron(double size = 1) {
  return {{{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

/// Six quads, outward.
inline PolygonSoup box(const Vec3& low, const Vec3& high) {
  PolygonSoup soup;
  for (int i = 0; i < 8; ++i)
    soup.points.emplace_back((i & 1 ? high : low).x(), (i & 2 ? high : low).y(),
                             (i & 4 ? high : low).z());
  soup.polygons = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                   {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return soup;
}

/// A closed grid of quads around two directions: point(i, j) with i and j periodic.
template <class Point>
PolygonSoup wrapped_grid(int n, int m, Point point) {
  PolygonSoup soup;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      soup.points.push_back(point(i, j));
      const int next_i = (i + 1) % n, next_j = (j + 1) % m;
      soup.polygons.push_back({i * m + j, next_i * m + j, next_i * m + next_j, i * m + next_j});
    }
  return soup;
}

inline PolygonSoup torus(double ring, double tube, int n = 48, int m = 24) {
  return wrapped_grid(n, m, [=](int i, int j) {
    const double a = 2 * pi * i / n, b = 2 * pi * j / m, rho = ring + tube * std::cos(b);
    return Vec3(rho * std::cos(a), rho * std::sin(a), tube * std::sin(b));
  });
}

/// Each triangle cut in four; `middle(a, b)` is the point between two.
template <class Middle>
PolygonSoup quartered(PolygonSoup soup, Middle middle) {
  std::map<std::pair<int, int>, int> middles;
  const auto between = [&](int a, int b) {
    const auto [at, added] = middles.try_emplace(std::minmax(a, b), soup.points.size());
    if (added) soup.points.push_back(middle(soup.points[a], soup.points[b]));
    return at->second;
  };
  std::vector<std::vector<int>> finer;
  for (const auto& f : soup.polygons) {
    const int ab = between(f[0], f[1]), bc = between(f[1], f[2]), ca = between(f[2], f[0]);
    finer.insert(finer.end(), {{f[0], ab, ca}, {f[1], bc, ab}, {f[2], ca, bc}, {ab, bc, ca}});
  }
  soup.polygons = finer;
  return soup;
}

/// An octahedron with each triangle cut in four `levels` times, points on the sphere.
inline PolygonSoup sphere(double radius, int levels, const Vec3& center = Vec3::Zero()) {
  PolygonSoup soup{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  const auto on_sphere = [](const Vec3& a, const Vec3& b) -> Vec3 { return (a + b).normalized(); };
  for (int level = 0; level < levels; ++level) soup = quartered(std::move(soup), on_sphere);
  for (Vec3& point : soup.points) point = center + radius * point;
  return soup;
}

/// A ball with bulges and hollows.
inline PolygonSoup bumpy_ball(int levels) {
  PolygonSoup soup = sphere(1, levels);
  for (Vec3& p : soup.points)
    p *= 1 + 0.35 * std::sin(5 * std::atan2(p.y(), p.x())) * (1 - p.z() * p.z()) +
         0.2 * std::sin(7 * p.z());
  return soup;
}

/// Both in one file, points of the second after those of the first.
inline PolygonSoup together(PolygonSoup a, const PolygonSoup& b) {
  const int offset = static_cast<int>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (auto polygon : b.polygons) {
    for (int& corner : polygon) corner += offset;
    a.polygons.push_back(polygon);
  }
  return a;
}

inline PolygonSoup inverted(PolygonSoup soup) {
  for (auto& polygon : soup.polygons) std::reverse(polygon.begin(), polygon.end());
  return soup;
}

inline PolygonSoup moved(PolygonSoup soup, const Vec3& by) {
  for (Vec3& point : soup.points) point += by;
  return soup;
}

/// A fraction of the faces, chosen at random, turned.
inline PolygonSoup flipped(PolygonSoup soup, double fraction, unsigned seed = 1) {
  std::mt19937 random(seed);
  for (auto& polygon : soup.polygons)
    if (random() < fraction * 4294967296.0) std::reverse(polygon.begin(), polygon.end());
  return soup;
}

/// A fraction of the faces, chosen at random, left out.
inline PolygonSoup without(PolygonSoup soup, double fraction, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::erase_if(soup.polygons, [&](const auto&) { return random() < fraction * 4294967296.0; });
  return soup;
}

/// Triangles cut in four until there are `faces` of them: the same surface.
inline PolygonSoup refined(PolygonSoup soup, std::size_t faces) {
  const auto halfway = [](const Vec3& a, const Vec3& b) -> Vec3 { return (a + b) / 2; };
  while (soup.polygons.size() < faces) soup = quartered(std::move(soup), halfway);
  return soup;
}

/// Every face with points of its own, moved by up to `jitter` along each axis.
inline PolygonSoup torn(const PolygonSoup& soup, double jitter) {
  std::mt19937 random(1);
  const auto shift = [&] { return jitter * (random() / 2147483648.0 - 1); };
  PolygonSoup pieces;
  for (auto polygon : soup.polygons) {
    for (int& corner : polygon) {
      const Vec3 by(shift(), shift(), shift());
      pieces.points.push_back(soup.points[corner] + by);
      corner = static_cast<int>(pieces.points.size()) - 1;
    }
    pieces.polygons.push_back(polygon);
  }
  return pieces;
}

/// Each face with points of its own, shrunk towards its middle: a soup of single triangles.
inline PolygonSoup burst(const PolygonSoup& soup, double size = 1) {
  PolygonSoup parts;
  for (const auto& f : soup.polygons) {
    Vec3 middle = Vec3::Zero();
    for (const int corner : f) middle += soup.points[corner] / static_cast<double>(f.size());
    parts.polygons.emplace_back();
    for (const int corner : f) {
      parts.polygons.back().push_back(static_cast<int>(parts.points.size()));
      const Vec3& place = soup.points[corner];
      parts.points.push_back(size == 1 ? place : middle + size * (place - middle));
    }
  }
  return parts;
}

/// `n` quads around a ring, two rows of them, with half a turn.
inline PolygonSoup moebius_strip(int n) {
  PolygonSoup soup;
  for (int i = 0; i < n; ++i)
    for (int j = -1; j <= 1; ++j) {
      const double a = 2 * pi * i / n, rho = 1 + 0.3 * j * std::cos(a / 2);
      soup.points.emplace_back(rho * std::cos(a), rho * std::sin(a), 0.3 * j * std::sin(a / 2));
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2; ++j) {
      const bool last = i + 1 == n;
      const int next = last ? 2 - j : 3 * (i + 1) + j, step = last ? -1 : 1;
      soup.polygons.push_back({3 * i + j, next, next + step, 3 * i + j + 1});
    }
  return soup;
}

/// n x n quads in the plane z = 0, x and y from 0 to 1.
inline PolygonSoup sheet(int n) {
  PolygonSoup soup;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) soup.points.emplace_back(i / double(n), j / double(n), 0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int at = i * (n + 1) + j;
      soup.polygons.push_back({at, at + n + 1, at + n + 2, at + 1});
    }
  return soup;
}

}  // namespace sinew::shapes
