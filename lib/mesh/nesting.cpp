// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/nesting.h"

#include <algorithm>
#include <cmath>

namespace sinew {
namespace {

struct Shell {
  std::vector<int> faces;
  Box box;
  Vec3 place;               ///< in the middle of its largest face
  std::vector<int> around;  ///< shells it lies in
};

double solid_angle(const Triangles& surface, int face, const Vec3& from) {
  const auto& [i, j, k] = surface.faces[face];
  const Vec3 a = surface.points[i] - from, b = surface.points[j] - from,
             c = surface.points[k] - from;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2 * std::atan2(a.dot(b.cross(c)), below);
}

bool encloses(const Triangles& surface, const Shell& shell, const Vec3& place) {
  if (!shell.box.contains(place)) return false;
  double angle = 0;
  for (const int face : shell.faces) angle += solid_angle(surface, face, place);
  return std::abs(angle) > 2 * pi;  // 4 pi within, 0 without
}

std::vector<Shell> gathered(const Triangles& surface, const Shells& shells) {
  std::vector<Shell> result(shells.count);
  std::vector<double> largest(shells.count, -1);
  for (std::size_t i = 0; i < surface.faces.size(); ++i) {
    Shell& shell = result[shells.of_face[i]];
    shell.faces.push_back(static_cast<int>(i));
    const auto& [p, q, r] = surface.faces[i];
    const Vec3 &a = surface.points[p], &b = surface.points[q], &c = surface.points[r];
    for (const Vec3* corner : {&a, &b, &c}) shell.box.extend(*corner);
    const double size = (b - a).cross(c - a).squaredNorm();
    if (size <= largest[shells.of_face[i]]) continue;
    largest[shells.of_face[i]] = size;
    shell.place = (a + b + c) / 3;
  }
  return result;
}

}  // namespace

Nesting nesting_of(const Triangles& surface, const Shells& shells) {
  std::vector<Shell> shell = gathered(surface, shells);
  for (int inner = 0; inner < shells.count; ++inner)
    for (int outer = 0; outer < shells.count; ++outer)
      if (inner != outer && encloses(surface, shell[outer], shell[inner].place))
        shell[inner].around.push_back(outer);

  Nesting nesting{std::vector<int>(shells.count), std::vector<bool>(shells.count), 0};
  for (int i = 0; i < shells.count; ++i) {
    nesting.cavity[i] = shell[i].around.size() % 2 == 1;
    if (!nesting.cavity[i]) nesting.body[i] = nesting.bodies++;
  }
  const auto depth = [&](int i) { return shell[i].around.size(); };
  for (int i = 0; i < shells.count; ++i) {
    if (!nesting.cavity[i]) continue;
    const auto& around = shell[i].around;  // of these the deepest is the next one outwards
    nesting.body[i] = nesting.body[*std::max_element(
        around.begin(), around.end(), [&](int a, int b) { return depth(a) < depth(b); })];
  }
  return nesting;
}

}  // namespace sinew
