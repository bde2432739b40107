// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/repair/volume_meshing.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace sinew {
namespace {

/// The sides of elements along one axis, ascending.
std::vector<double> sides(double low, double high, double size, const std::vector<double>& cuts) {
  std::vector<double> walls = {low, high};
  for (const double cut : cuts)
    if (cut > low && cut < high && std::none_of(walls.begin(), walls.end(), [&](double wall) {
          return std::abs(wall - cut) < size / 10;
        }))
      walls.push_back(cut);
  std::sort(walls.begin(), walls.end());
  std::vector<double> all = {low};
  for (std::size_t k = 1; k < walls.size(); ++k) {
    const double from = walls[k - 1], length = walls[k] - from;
    const int parts = std::max(1, static_cast<int>(std::ceil(length / size - 1e-9)));
    for (int part = 1; part < parts; ++part) all.push_back(from + length * part / parts);
    all.push_back(walls[k]);
  }
  return all;
}

}  // namespace

std::optional<Box> axis_box(const Triangles& surface) {
  constexpr double slack = 1e-6;  // fraction of its volume and area
  const Box box = bounds(surface.points);
  if (box.isEmpty() || !(box.volume() > 0)) return std::nullopt;
  const Vec3 size = box.sizes();
  const double skin = 2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
  const bool same = std::abs(volume(surface) / box.volume() - 1) < slack &&
                    std::abs(area(surface) / skin - 1) < slack;
  return same ? std::optional(box) : std::nullopt;
}

VolumeMesh hexahedra(const Box& box, double size, const Cuts& cuts) {
  std::array<std::vector<double>, 3> at;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<int>(axis);
    at[axis] = sides(box.min()[a], box.max()[a], size, cuts[axis]);
  }
  VolumeMesh mesh;
  for (const double z : at[2])
    for (const double y : at[1])
      for (const double x : at[0]) mesh.nodes.emplace_back(x, y, z);
  const auto node = [&](std::size_t i, std::size_t j, std::size_t k) {
    return static_cast<std::uint32_t>((k * at[1].size() + j) * at[0].size() + i);
  };
  for (std::size_t k = 0; k + 1 < at[2].size(); ++k)
    for (std::size_t j = 0; j + 1 < at[1].size(); ++j)
      for (std::size_t i = 0; i + 1 < at[0].size(); ++i)
        mesh.elements.push_back({ElementKind::hexahedron8,
                                 {node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k),
                                  node(i, j + 1, k), node(i, j, k + 1), node(i + 1, j, k + 1),
                                  node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)}});
  return second_order(std::move(mesh));
}

}  // namespace sinew
