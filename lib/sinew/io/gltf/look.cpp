// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/look.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <sinew/io/gltf/detail/accessors.h>
#include <sinew/io/gltf/detail/materials.h>
#include <sinew/io/gltf/geometry.h>

namespace sinew {
namespace {

/// Primitive in the mesh of a node.
using PrimitivePlace = std::pair<int, int>;  ///< node, primitive

/// The values of a primitive's attributes, read once each.
class Attributes {
 public:
  Attributes(const CheckedGltf& gltf, const GltfPrimitive& primitive)
      : gltf_(gltf), primitive_(primitive) {}

  /// All values, `components` for each vertex; empty where the primitive has no such attribute.
  const std::vector<double>& of(const std::string& name, int components) {
    const auto [found, is_first] = values_.try_emplace({name, components});
    if (is_first) found->second = read(name, components);
    return found->second;
  }

 private:
  std::vector<double> read(const std::string& name, int components) const {
    const auto attribute = primitive_.attributes.find(name);
    const auto& accessors = gltf_.document.accessors;
    if (attribute == primitive_.attributes.end() ||
        static_cast<std::size_t>(attribute->second) >= accessors.size())
      return {};
    const GltfAccessor& accessor = accessors[static_cast<std::size_t>(attribute->second)];
    const auto positions = static_cast<std::size_t>(primitive_.positions());
    if (accessor.view < 0 || accessor.count != accessors[positions].count ||
        components_of(accessor.type) != components || accessor.type.starts_with("MAT"))
      return {};
    std::vector<double> values = gltf_numbers(gltf_, attribute->second);
    for (double& value : values)
      if (!std::isfinite(value)) value = 0;
    return values;
  }

  const CheckedGltf& gltf_;
  const GltfPrimitive& primitive_;
  std::map<std::pair<std::string, int>, std::vector<double>> values_;
};

/// Fills a look vertex by vertex of the soup.
class LookReader {
 public:
  LookReader(const CheckedGltf& gltf, const std::vector<GltfShape>& shapes,
             const std::vector<std::string>& materials, PolygonLook& look)
      : gltf_(gltf), materials_(materials), out_(look), look_(look.look) {
    for (const GltfShape& shape : shapes)
      turn_[shape.node] = shape.place.linear().inverse().transpose();
    for_each_primitive(gltf.document, [&](const GltfPrimitive& primitive, const std::string&) {
      for (const auto& [name, accessor] : primitive.attributes) add_layer(name);
    });
  }

  void read(const GltfTriangles& triangles) {
    for (const GltfVertex& vertex : triangles.sources) add_vertex(vertex);
    for (const std::vector<int>& face : triangles.soup.polygons) {
      look_.part.push_back(part_of(triangles.sources[static_cast<std::size_t>(face[0])]));
      out_.corners.push_back(where(face, has_coordinates_));
      out_.normal_corners.push_back(where(face, has_normal_));
      out_.layer_corners.push_back(face);
    }
    const auto none = [](const std::vector<bool>& given) {
      return std::find(given.begin(), given.end(), true) == given.end();
    };
    if (none(has_coordinates_)) look_.coordinates.clear();
    if (none(has_normal_)) look_.normals.clear();
  }

 private:
  static bool is_color(const std::string& name) { return name.starts_with("COLOR_"); }

  void add_layer(const std::string& name) {
    if (!is_color(name) && (!name.starts_with("TEXCOORD_") || name == "TEXCOORD_0")) return;
    for (const SurfaceLook::Layer& layer : look_.layers)
      if (layer.name == name) return;
    look_.layers.push_back({name, is_color(name) ? 4 : 2, {}});
  }

  const GltfMesh& mesh_of(int node) const {
    const auto mesh = gltf_.document.nodes[static_cast<std::size_t>(node)].mesh;
    return gltf_.document.meshes[static_cast<std::size_t>(mesh)];
  }

  const GltfPrimitive& primitive_of(const GltfVertex& vertex) const {
    return mesh_of(vertex.node).primitives[static_cast<std::size_t>(vertex.primitive)];
  }

  Attributes& attributes_of(const GltfVertex& vertex) {
    const GltfPrimitive& primitive = primitive_of(vertex);
    return attributes_.try_emplace(&primitive, gltf_, primitive).first->second;
  }

  void add_vertex(const GltfVertex& vertex) {
    Attributes& attributes = attributes_of(vertex);
    const auto at = static_cast<std::size_t>(vertex.vertex);
    const auto& uv = attributes.of("TEXCOORD_0", 2);
    has_coordinates_.push_back(!uv.empty());
    look_.coordinates.push_back(uv.empty() ? std::array{0.0, 0.0}
                                           : std::array{uv[2 * at], 1 - uv[2 * at + 1]});
    look_.normals.push_back(normal_of(attributes.of("NORMAL", 3), at, turn_[vertex.node]));
    has_normal_.push_back(!look_.normals.back().isZero(0));
    for (SurfaceLook::Layer& layer : look_.layers) add_values(layer, attributes, at);
  }

  /// Zero where there is none, or none with a direction.
  static Vec3 normal_of(const std::vector<double>& normals, std::size_t at, const Mat3& turn) {
    if (normals.empty()) return Vec3::Zero();
    const Vec3 normal = direction_of(turn * Vec3(normals.data() + 3 * at));
    return normal.allFinite() ? normal : Vec3::Zero();
  }

  /// White, or zero, where the vertex has none; colors without opacity are opaque.
  static void add_values(SurfaceLook::Layer& layer, Attributes& attributes, std::size_t at) {
    const double missing = is_color(layer.name) ? 1 : 0;
    const auto* values = &attributes.of(layer.name, layer.components);
    auto given = static_cast<std::size_t>(layer.components);
    if (values->empty() && is_color(layer.name)) values = &attributes.of(layer.name, 3), given = 3;
    for (std::size_t c = 0; c < static_cast<std::size_t>(layer.components); ++c)
      layer.values.push_back(
          static_cast<float>(values->empty() || c >= given ? missing : (*values)[given * at + c]));
  }

  static std::vector<int> where(std::vector<int> face, const std::vector<bool>& given) {
    for (int& vertex : face)
      if (!given[static_cast<std::size_t>(vertex)]) vertex = -1;
    return face;
  }

  int part_of(const GltfVertex& vertex) {
    const auto [found, is_new] =
        parts_.try_emplace({vertex.node, vertex.primitive}, static_cast<int>(look_.parts.size()));
    if (!is_new) return found->second;
    const GltfNode& node = gltf_.document.nodes[static_cast<std::size_t>(vertex.node)];
    const GltfMesh& mesh = mesh_of(vertex.node);
    SurfaceLook::Part part{node.name.empty() ? mesh.name : node.name, "", "", -1};
    const int material = primitive_of(vertex).material;
    if (material >= 0 && static_cast<std::size_t>(material) < materials_.size()) {
      part.material = materials_[static_cast<std::size_t>(material)];
      part.gltf_material = material;
    }
    look_.parts.push_back(std::move(part));
    return found->second;
  }

  const CheckedGltf& gltf_;
  const std::vector<std::string>& materials_;
  PolygonLook& out_;
  SurfaceLook& look_;
  std::map<int, Mat3> turn_;  // turn of normals, by node
  std::map<const GltfPrimitive*, Attributes> attributes_;
  std::map<PrimitivePlace, int> parts_;
  std::vector<bool> has_coordinates_, has_normal_;  // per vertex
};

}  // namespace

PolygonSoup read_gltf_look(const std::filesystem::path& path, PolygonLook& look) {
  PolygonSoup soup = read_gltf(path);  // with its messages
  const CheckedGltf gltf = checked_gltf(path);
  const std::vector<GltfShape> shapes = gltf_shapes(gltf);
  look.look.gltf = gltf_materials(path, gltf);
  const std::vector<std::string> materials = names_of(look.look.gltf);
  LookReader(gltf, shapes, materials, look).read(gltf_triangles(gltf, shapes));
  return soup;
}

}  // namespace sinew
