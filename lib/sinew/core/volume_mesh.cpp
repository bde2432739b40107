// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/volume_mesh.h>

#include <algorithm>
#include <map>

namespace sinew {
namespace {

using Edge = std::array<int, 2>;

constexpr std::array<Edge, 12> hexahedron_edges = {{{0, 1},
                                                    {1, 2},
                                                    {2, 3},
                                                    {3, 0},
                                                    {4, 5},
                                                    {5, 6},
                                                    {6, 7},
                                                    {7, 4},
                                                    {0, 4},
                                                    {1, 5},
                                                    {2, 6},
                                                    {3, 7}}};
constexpr std::array<Edge, 6> tetrahedron_edges = {
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

constexpr std::array<std::array<int, 4>, 6> hexahedron_faces = {
    {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}};
constexpr std::array<std::array<int, 3>, 4> tetrahedron_faces = {
    {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};

std::span<const int> corners_of_face(ElementKind kind, int face) {
  const auto number = static_cast<std::size_t>(face);
  if (is_hexahedron(kind)) return hexahedron_faces[number];
  return tetrahedron_faces[number];
}

int faces_of(ElementKind kind) { return is_hexahedron(kind) ? 6 : 4; }

/// Between two corners.
int middle_of(ElementKind kind, int a, int b) {
  const auto edges = edges_of(kind);
  const auto found = std::find_if(edges.begin(), edges.end(), [&](const Edge& edge) {
    return (edge[0] == a && edge[1] == b) || (edge[0] == b && edge[1] == a);
  });
  return corners_of(kind) + static_cast<int>(found - edges.begin());
}

bool is_second_order(ElementKind kind) { return nodes_of(kind) > corners_of(kind); }

double volume_of_four(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).cross(c - a).dot(d - a) / 6;
}

}  // namespace

std::span<const std::array<int, 2>> edges_of(ElementKind kind) {
  if (is_hexahedron(kind)) return hexahedron_edges;
  return tetrahedron_edges;
}

VolumeMesh second_order(VolumeMesh mesh) {
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> middles;
  for (VolumeElement& element : mesh.elements) {
    if (is_second_order(element.kind)) continue;
    auto place = static_cast<std::size_t>(corners_of(element.kind));
    for (const auto& [from, to] : edges_of(element.kind)) {
      const std::uint32_t a = element.nodes[static_cast<std::size_t>(from)],
                          b = element.nodes[static_cast<std::size_t>(to)];
      const auto [found, fresh] = middles.try_emplace(
          {std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(mesh.nodes.size()));
      if (fresh) mesh.nodes.push_back((mesh.nodes[a] + mesh.nodes[b]) / 2);
      element.nodes[place++] = found->second;
    }
    element.kind =
        is_hexahedron(element.kind) ? ElementKind::hexahedron20 : ElementKind::tetrahedron10;
  }
  return mesh;
}

Vec3 center_of(const VolumeMesh& mesh, const VolumeElement& element) {
  const int corners = corners_of(element.kind);
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t node : element.used().first(static_cast<std::size_t>(corners)))
    sum += mesh.nodes[node];
  return sum / corners;
}

double volume_of(const VolumeMesh& mesh, const VolumeElement& element) {
  constexpr std::array<std::array<std::size_t, 4>, 6> parts = {
      {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}}};
  const auto at = [&](std::size_t node) { return mesh.nodes[element.nodes[node]]; };
  if (!is_hexahedron(element.kind)) return volume_of_four(at(0), at(1), at(2), at(3));
  double sum = 0;
  for (const auto& [a, b, c, d] : parts) sum += volume_of_four(at(a), at(b), at(c), at(d));
  return sum;
}

std::span<const double> nodal_volume_weights(ElementKind kind) {
  static constexpr std::array<double, 8> of_8 = {.125, .125, .125, .125, .125, .125, .125, .125};
  static constexpr std::array<double, 4> of_4 = {.25, .25, .25, .25};
  static constexpr std::array<double, 10> of_10 = {-.05, -.05, -.05, -.05, .2, .2, .2, .2, .2, .2};
  static const std::array<double, 20> of_20 = [] {
    std::array<double, 20> weights{};
    std::fill_n(weights.begin(), 8, -1.0 / 8);
    std::fill_n(weights.begin() + 8, 12, 1.0 / 6);
    return weights;
  }();
  switch (kind) {
    case ElementKind::hexahedron8:
      return of_8;
    case ElementKind::hexahedron20:
      return of_20;
    case ElementKind::tetrahedron4:
      return of_4;
    case ElementKind::tetrahedron10:
      return of_10;
  }
  return {};
}

// Faces.

std::vector<std::uint32_t> face_nodes(const VolumeElement& element, int face) {
  const auto corners = corners_of_face(element.kind, face);
  std::vector<std::uint32_t> nodes;
  for (const int corner : corners) nodes.push_back(element.nodes[static_cast<std::size_t>(corner)]);
  if (!is_second_order(element.kind)) return nodes;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const int middle = middle_of(element.kind, corners[k], corners[(k + 1) % corners.size()]);
    nodes.push_back(element.nodes[static_cast<std::size_t>(middle)]);
  }
  return nodes;
}

std::span<const double> nodal_face_weights(ElementKind kind) {
  static constexpr double a = -1.0 / 12, b = 1.0 / 3;
  static constexpr std::array<double, 4> of_4 = {.25, .25, .25, .25};
  static constexpr std::array<double, 8> of_8 = {a, a, a, a, b, b, b, b};
  static constexpr std::array<double, 3> of_3 = {b, b, b};
  static constexpr std::array<double, 6> of_6 = {0, 0, 0, b, b, b};
  switch (kind) {
    case ElementKind::hexahedron8:
      return of_4;
    case ElementKind::hexahedron20:
      return of_8;
    case ElementKind::tetrahedron4:
      return of_3;
    case ElementKind::tetrahedron10:
      return of_6;
  }
  return {};
}

Vec3 center_of(const VolumeMesh& mesh, const ElementFace& face) {
  const VolumeElement& element = mesh.elements[face.element];
  const auto corners = corners_of_face(element.kind, face.face);
  Vec3 sum = Vec3::Zero();
  for (const int corner : corners)
    sum += mesh.nodes[element.nodes[static_cast<std::size_t>(corner)]];
  return sum / static_cast<double>(corners.size());
}

Vec3 area_vector(const VolumeMesh& mesh, const ElementFace& face) {
  const VolumeElement& element = mesh.elements[face.element];
  const auto corners = corners_of_face(element.kind, face.face);
  const Vec3 middle = center_of(mesh, face);
  Vec3 area = Vec3::Zero();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const auto from = static_cast<std::size_t>(corners[k]),
               to = static_cast<std::size_t>(corners[(k + 1) % corners.size()]);
    area +=
        (mesh.nodes[element.nodes[from]] - middle).cross(mesh.nodes[element.nodes[to]] - middle) /
        2;
  }
  return area.dot(middle - center_of(mesh, element)) < 0 ? Vec3(-area) : area;
}

std::vector<ElementFace> boundary_faces(const VolumeMesh& mesh) {
  std::map<std::vector<std::uint32_t>, std::pair<ElementFace, int>> uses;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const VolumeElement& element = mesh.elements[e];
    for (int face = 0; face < faces_of(element.kind); ++face) {
      std::vector<std::uint32_t> corners;
      for (const int corner : corners_of_face(element.kind, face))
        corners.push_back(element.nodes[static_cast<std::size_t>(corner)]);
      std::sort(corners.begin(), corners.end());
      auto& use = uses[corners];
      use.first = {static_cast<std::uint32_t>(e), face};
      ++use.second;
    }
  }
  std::vector<ElementFace> faces;
  for (const auto& [corners, use] : uses)
    if (use.second == 1) faces.push_back(use.first);
  std::sort(faces.begin(), faces.end(), [](const ElementFace& a, const ElementFace& b) {
    return a.element != b.element ? a.element < b.element : a.face < b.face;
  });
  return faces;
}

// Shape functions.

namespace {

/// Signs of the local coordinates at the corners.
constexpr std::array<std::array<double, 3>, 8> hexahedron_corners = {{{-1, -1, -1},
                                                                      {1, -1, -1},
                                                                      {1, 1, -1},
                                                                      {-1, 1, -1},
                                                                      {-1, -1, 1},
                                                                      {1, -1, 1},
                                                                      {1, 1, 1},
                                                                      {-1, 1, 1}}};

Vec3 corner_of(int k) {
  const auto& [x, y, z] = hexahedron_corners[static_cast<std::size_t>(k)];
  return {x, y, z};
}

/// The product of three factors, each of one coordinate, and its derivatives.
void set_product(ShapeFunctions& out, std::size_t node, double scale, const Vec3& factor,
                 const Vec3& slope) {
  out.value[node] = scale * factor.prod();
  out.slope[node] =
      scale * Vec3(slope.x() * factor.y() * factor.z(), factor.x() * slope.y() * factor.z(),
                   factor.x() * factor.y() * slope.z());
}

/// A middle node where coordinate `axis` is 0: (1 - x^2) (1 + s y) (1 + s z) / 4.
void set_middle(ShapeFunctions& out, std::size_t node, const Vec3& signs, const Vec3& x) {
  Vec3 factor, slope;
  for (int k = 0; k < 3; ++k) {
    const bool along = signs[k] == 0;
    factor[k] = along ? 1 - x[k] * x[k] : 1 + signs[k] * x[k];
    slope[k] = along ? -2 * x[k] : signs[k];
  }
  set_product(out, node, 0.25, factor, slope);
}

ShapeFunctions of_hexahedron(const Vec3& x, bool second) {
  ShapeFunctions out;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 signs = corner_of(corner);
    const Vec3 factor = Vec3::Ones() + signs.cwiseProduct(x);
    set_product(out, static_cast<std::size_t>(corner), 0.125, factor, signs);
  }
  if (!second) return out;
  for (std::size_t k = 0; k < hexahedron_edges.size(); ++k) {
    const auto& [from, to] = hexahedron_edges[k];
    const std::size_t node = 8 + k;
    set_middle(out, node, (corner_of(from) + corner_of(to)) / 2, x);
    for (const int corner : {from, to}) {  // what vanishes at the middles
      const auto c = static_cast<std::size_t>(corner);
      out.value[c] -= out.value[node] / 2;
      out.slope[c] -= out.slope[node] / 2;
    }
  }
  return out;
}

ShapeFunctions of_tetrahedron(const Vec3& x, bool second) {
  const std::array<double, 4> barycentric = {1 - x.sum(), x.x(), x.y(), x.z()};
  const std::array<Vec3, 4> slope = {-Vec3::Ones(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  ShapeFunctions out;
  for (std::size_t k = 0; k < 4; ++k) {
    out.value[k] = second ? barycentric[k] * (2 * barycentric[k] - 1) : barycentric[k];
    out.slope[k] = second ? Vec3((4 * barycentric[k] - 1) * slope[k]) : slope[k];
  }
  if (!second) return out;
  for (std::size_t k = 0; k < tetrahedron_edges.size(); ++k) {
    const auto a = static_cast<std::size_t>(tetrahedron_edges[k][0]),
               b = static_cast<std::size_t>(tetrahedron_edges[k][1]);
    out.value[4 + k] = 4 * barycentric[a] * barycentric[b];
    out.slope[4 + k] = 4 * (barycentric[a] * slope[b] + barycentric[b] * slope[a]);
  }
  return out;
}

}  // namespace

ShapeFunctions shape_functions(ElementKind kind, const Vec3& local) {
  return is_hexahedron(kind) ? of_hexahedron(local, is_second_order(kind))
                             : of_tetrahedron(local, is_second_order(kind));
}

double outside_by(ElementKind kind, const Vec3& local) {
  if (is_hexahedron(kind)) return std::max(0.0, (local.cwiseAbs().maxCoeff() - 1) / 2);
  return std::max({0.0, -local.minCoeff(), local.sum() - 1});
}

}  // namespace sinew
