// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/geometry.h>

#include <algorithm>
#include <limits>
#include <new>
#include <numeric>
#include <optional>
#include <utility>

#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/detail/accessors.h>
#include <sinew/io/gltf/detail/weights.h>

namespace sinew {
namespace {

const GltfAccessor& accessor_at(const CheckedGltf& gltf, int accessor) {
  return gltf.document.accessors[static_cast<std::size_t>(accessor)];
}

/// The vertices of a primitive's triangles.
class Corners {
 public:
  Corners(const CheckedGltf& gltf, const GltfPrimitive& primitive)
      : mode_(primitive.mode), count_(accessor_at(gltf, primitive.positions()).count) {
    if (primitive.indices < 0) return;
    const GltfAccessor& indices = accessor_at(gltf, primitive.indices);
    count_ = indices.count;
    indices_.emplace(gltf, indices);
  }

  /// Calls visit(a, b, c) for each triangle, all in the same orientation.
  template <class Visit>
  void for_each_triangle(const Visit& visit) const {
    if (mode_ == GltfMode::triangles)
      for (std::int64_t i = 0; i + 2 < count_; i += 3) visit(at(i), at(i + 1), at(i + 2));
    if (mode_ == GltfMode::triangle_fan)
      for (std::int64_t i = 1; i + 1 < count_; ++i) visit(at(0), at(i), at(i + 1));
    if (mode_ == GltfMode::triangle_strip)
      for (std::int64_t i = 0; i + 2 < count_; ++i) {
        // Every second triangle is reversed; degenerate ones only connect parts of the strip.
        const std::int64_t a = at(i), b = at(i + 1 + i % 2), c = at(i + 2 - i % 2);
        if (a != b && b != c && c != a) visit(a, b, c);
      }
  }

 private:
  std::int64_t at(std::int64_t i) const { return indices_ ? indices_->index(i) : i; }

  GltfMode mode_;
  std::int64_t count_;
  std::optional<GltfElements> indices_;  // none: the vertices in their order
};

/// x y z of a primitive's points, with its morph targets at rest.
std::vector<double> positions_of(const CheckedGltf& gltf, const GltfNode& node,
                                 const GltfMesh& mesh, const GltfPrimitive& primitive) {
  std::vector<double> positions = gltf_numbers(gltf, primitive.positions());
  const std::vector<double>& weights = node.weights.empty() ? mesh.weights : node.weights;
  for (std::size_t i = 0; i < std::min(weights.size(), primitive.targets.size()); ++i) {
    if (weights[i] == 0 || primitive.targets[i] < 0) continue;
    const std::vector<double> moved = gltf_numbers(gltf, primitive.targets[i]);
    for (std::size_t k = 0; k < positions.size(); ++k) positions[k] += weights[i] * moved[k];
  }
  return positions;
}

/// The points in the scene.
Points placed(const std::vector<double>& positions, const GltfShape& shape,
              const std::optional<GltfWeights>& weights) {
  std::vector<int> joints(shape.carried.size());
  std::iota(joints.begin(), joints.end(), 0);
  Points points;
  for (std::size_t i = 0; i < positions.size() / 3; ++i) {
    const Vec3 point(positions.data() + 3 * i);
    const auto blended = weights ? weights->of(i, joints) : std::vector<BoneWeight>();
    Vec3 place = blended.empty() ? Vec3(shape.place * point) : Vec3::Zero();
    for (const BoneWeight& one : blended)
      place += one.weight * (shape.carried[static_cast<std::size_t>(one.bone)] * point);
    points.push_back(place);
  }
  return points;
}

/// Adds the triangles of one primitive to a soup, with the vertices they use.
class Paste {
 public:
  Paste(Points points, const GltfShape& shape, int primitive, GltfTriangles& triangles)
      : points_(std::move(points)),
        shape_(shape),
        primitive_(primitive),
        mirrors_(shape.place.linear().determinant() < 0),
        places_(points_.size(), -1),
        triangles_(triangles) {}

  void triangle(std::int64_t a, std::int64_t b, std::int64_t c) {
    if (mirrors_) std::swap(b, c);
    triangles_.soup.polygons.push_back({vertex(a), vertex(b), vertex(c)});
  }

 private:
  int vertex(std::int64_t index) {
    const auto at = static_cast<std::size_t>(index);
    if (at >= places_.size())
      throw damaged_gltf("a triangle names vertex " + std::to_string(index) + " of " +
                         std::to_string(places_.size()));
    if (places_[at] < 0) places_[at] = added(at);
    return places_[at];
  }

  int added(std::size_t at) {
    const Vec3& point = points_[at];
    if (!point.allFinite()) throw damaged_gltf("vertex " + std::to_string(at) + " is not finite");
    triangles_.soup.points.push_back(point);
    triangles_.sources.push_back({shape_.node, primitive_, static_cast<int>(at)});
    return static_cast<int>(triangles_.soup.points.size()) - 1;
  }

  Points points_;
  const GltfShape& shape_;
  int primitive_;
  bool mirrors_;
  std::vector<int> places_;  // places of vertices in the soup, -1 for unused ones
  GltfTriangles& triangles_;
};

void paste_mesh(const CheckedGltf& gltf, const GltfShape& shape, GltfTriangles& triangles) {
  const GltfNode& node = gltf.document.nodes[static_cast<std::size_t>(shape.node)];
  const auto index = static_cast<std::size_t>(node.mesh);
  const GltfMesh& mesh = gltf.document.meshes[index];
  for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
    const GltfPrimitive& primitive = mesh.primitives[i];
    if (!primitive.is_surface()) continue;
    std::optional<GltfWeights> weights;
    if (!shape.carried.empty()) weights.emplace(gltf, index, i, shape.carried.size());
    Paste paste(placed(positions_of(gltf, node, mesh, primitive), shape, weights), shape,
                static_cast<int>(i), triangles);
    Corners(gltf, primitive).for_each_triangle([&](std::int64_t a, std::int64_t b, std::int64_t c) {
      paste.triangle(a, b, c);
    });
  }
}

int mesh_of(const GltfDocument& document, const GltfShape& shape) {
  return document.nodes[static_cast<std::size_t>(shape.node)].mesh;
}

struct MeshSize {
  double vertices = 0, triangles = 0;  // at most
};

MeshSize size_of(const GltfDocument& document, const GltfMesh& mesh) {
  const auto count_of = [&](int accessor) {
    return static_cast<double>(document.accessors[static_cast<std::size_t>(accessor)].count);
  };
  MeshSize size;
  for (const GltfPrimitive& primitive : mesh.primitives) {
    if (!primitive.is_surface()) continue;
    const double vertices = count_of(primitive.positions());
    const double corners = primitive.indices < 0 ? vertices : count_of(primitive.indices);
    size.vertices += vertices;
    size.triangles += primitive.mode == GltfMode::triangles ? corners / 3 : corners - 2;
  }
  return size;
}

/// A small file can instance one mesh many thousand times.
void check_size(const CheckedGltf& gltf, const std::vector<GltfShape>& shapes) {
  constexpr double vertex = 64, triangle = 56;  // bytes
  std::vector<MeshSize> sizes;
  for (const GltfMesh& mesh : gltf.document.meshes) sizes.push_back(size_of(gltf.document, mesh));
  MeshSize all;
  for (const GltfShape& shape : shapes) {
    const MeshSize& size = sizes[static_cast<std::size_t>(mesh_of(gltf.document, shape))];
    all.vertices += size.vertices;
    all.triangles += size.triangles;
  }
  const double bytes = all.vertices * vertex + all.triangles * triangle;
  if (bytes > available_memory() || all.vertices > std::numeric_limits<int>::max())
    throw bad_input("its scene shows " + std::to_string(static_cast<std::int64_t>(all.triangles)) +
                        " triangles, too many for memory",
                    "reduce their number");
}

/// The name of a node, or else of its mesh, with a surface; "" for other nodes.
std::string name_of_shown(const GltfDocument& document, int index) {
  const GltfNode& node = document.nodes[static_cast<std::size_t>(index)];
  if (node.mesh < 0) return "";
  const GltfMesh& mesh = document.meshes[static_cast<std::size_t>(node.mesh)];
  if (std::none_of(mesh.primitives.begin(), mesh.primitives.end(),
                   [](const GltfPrimitive& part) { return part.is_surface(); }))
    return "";
  if (!node.name.empty()) return node.name;
  return mesh.name.empty() ? "mesh_" + std::to_string(node.mesh) : mesh.name;
}

PolygonSoup soup_of(const CheckedGltf& gltf) {
  PolygonSoup soup = gltf_triangles(gltf, gltf_shapes(gltf)).soup;
  if (soup.polygons.empty())
    throw bad_input("its scene shows no triangles", "export it with a mesh");
  if (gltf.document.moves_morphs)
    soup.warning = "it is animated by morph targets, which are not read: they stay as at rest";
  return soup;
}

}  // namespace

/// Skinned meshes are placed by the skin's bind pose, not by their nodes.
std::vector<GltfShape> gltf_shapes(const CheckedGltf& gltf, const GltfBindPose& bind) {
  std::vector<GltfShape> shapes;
  for (const int index : gltf.shown) {
    const GltfNode& node = gltf.document.nodes[static_cast<std::size_t>(index)];
    const auto skin = static_cast<std::size_t>(node.skin);
    if (node.mesh >= 0 && node.skin >= 0)
      shapes.push_back({index, bind.meshes[skin], bind.carried[skin], -1});
    else if (node.mesh >= 0)
      shapes.push_back({index,
                        bind.nodes[static_cast<std::size_t>(index)],
                        {},
                        bind.holders[static_cast<std::size_t>(index)]});
  }
  return shapes;
}

std::vector<GltfShape> gltf_shapes(const CheckedGltf& gltf) {
  return gltf_shapes(gltf, gltf_bind_pose(gltf));
}

GltfTriangles gltf_triangles(const CheckedGltf& gltf, const std::vector<GltfShape>& shapes) {
  check_size(gltf, shapes);
  GltfTriangles triangles;
  for (const GltfShape& shape : shapes) {
    const int mesh = mesh_of(gltf.document, shape);
    const auto at = static_cast<std::size_t>(mesh);
    try {
      paste_mesh(gltf, shape, triangles);
    } catch (const Error& error) {
      const std::string& name = gltf.document.meshes[at].name;
      throw error.with_context({"mesh " + std::to_string(mesh) + ' ' + shown(name)});
    }
  }
  return triangles;
}

std::vector<std::string> gltf_mesh_names(const std::filesystem::path& path) {
  const CheckedGltf gltf = checked_gltf(path);
  std::vector<std::string> names;
  for (const int index : gltf.shown)
    if (std::string name = name_of_shown(gltf.document, index); !name.empty())
      names.push_back(std::move(name));
  return names;
}

PolygonSoup read_gltf_meshes(const std::filesystem::path& path,
                             const std::vector<std::string>& names) {
  const std::vector<std::string> known = gltf_mesh_names(path);
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw bad_input({path.string()}, "there is no mesh " + shown(name),
                      suggestion(name, std::vector<std::string_view>(known.begin(), known.end())));
  const CheckedGltf gltf = checked_gltf(path);
  std::vector<GltfShape> shapes = gltf_shapes(gltf);
  std::erase_if(shapes, [&](const GltfShape& shape) {
    return std::find(names.begin(), names.end(), name_of_shown(gltf.document, shape.node)) ==
           names.end();
  });
  return gltf_triangles(gltf, shapes).soup;
}

PolygonSoup read_gltf(const std::filesystem::path& path) {
  try {
    const CheckedGltf gltf = checked_gltf(path);
    try {
      return soup_of(gltf);
    } catch (const Error& error) {
      throw error.with_context({path.string()});
    }
  } catch (const std::bad_alloc&) {
    throw bad_input({path.string()}, "it takes more memory than there is",
                    "reduce its number of triangles");
  }
}

}  // namespace sinew
