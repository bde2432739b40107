// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/geometry.h>

#include <limits>
#include <new>
#include <optional>
#include <utility>

#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/detail/accessors.h>

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

/// Adds the triangles of one primitive to a soup, with the vertices they use.
class Paste {
 public:
  Paste(std::vector<double> positions, const GltfShape& shape, int primitive,
        GltfTriangles& triangles)
      : positions_(std::move(positions)),
        shape_(shape),
        primitive_(primitive),
        mirrors_(shape.place.linear().determinant() < 0),
        places_(positions_.size() / 3, -1),
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
    const Vec3 point = shape_.place * Vec3(positions_.data() + 3 * at);
    if (!point.allFinite()) throw damaged_gltf("vertex " + std::to_string(at) + " is not finite");
    triangles_.soup.points.push_back(point);
    triangles_.sources.push_back({shape_.node, primitive_, static_cast<int>(at)});
    return static_cast<int>(triangles_.soup.points.size()) - 1;
  }

  std::vector<double> positions_;
  const GltfShape& shape_;
  int primitive_;
  bool mirrors_;
  std::vector<int> places_;  // places of vertices in the soup, -1 for unused ones
  GltfTriangles& triangles_;
};

void paste_mesh(const CheckedGltf& gltf, const GltfMesh& mesh, const GltfShape& shape,
                GltfTriangles& triangles) {
  for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
    const GltfPrimitive& primitive = mesh.primitives[i];
    if (!primitive.is_surface()) continue;
    Paste paste(gltf_numbers(gltf, primitive.positions()), shape, static_cast<int>(i), triangles);
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

bool is_skinned(const CheckedGltf& gltf) {
  for (const int index : gltf.shown) {
    const GltfNode& node = gltf.document.nodes[static_cast<std::size_t>(index)];
    if (node.mesh >= 0 && node.skin >= 0) return true;
  }
  return false;
}

PolygonSoup soup_of(const CheckedGltf& gltf) {
  PolygonSoup soup = gltf_triangles(gltf, gltf_shapes(gltf)).soup;
  if (soup.polygons.empty())
    throw bad_input("its scene shows no triangles", "export it with a mesh");
  return soup;
}

}  // namespace

/// Skinned meshes are placed by the skin's bind pose, not by their nodes.
std::vector<GltfShape> gltf_shapes(const CheckedGltf& gltf) {
  std::vector<Affine> local;
  for (const GltfNode& node : gltf.document.nodes) local.push_back(place_of(node).affine());
  const std::vector<Affine> global = global_places(gltf.tree, local);
  const GltfBindPose bind = is_skinned(gltf) ? gltf_bind_pose(gltf) : GltfBindPose();
  std::vector<GltfShape> shapes;
  for (const int index : gltf.shown) {
    const GltfNode& node = gltf.document.nodes[static_cast<std::size_t>(index)];
    if (node.mesh >= 0)
      shapes.push_back({index, node.skin < 0 ? global[static_cast<std::size_t>(index)]
                                             : bind.meshes[static_cast<std::size_t>(node.skin)]});
  }
  return shapes;
}

GltfTriangles gltf_triangles(const CheckedGltf& gltf, const std::vector<GltfShape>& shapes) {
  check_size(gltf, shapes);
  GltfTriangles triangles;
  for (const GltfShape& shape : shapes) {
    const int mesh = mesh_of(gltf.document, shape);
    const auto at = static_cast<std::size_t>(mesh);
    try {
      paste_mesh(gltf, gltf.document.meshes[at], shape, triangles);
    } catch (const Error& error) {
      const std::string& name = gltf.document.meshes[at].name;
      throw error.with_context({"mesh " + std::to_string(mesh) + ' ' + shown(name)});
    }
  }
  return triangles;
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
