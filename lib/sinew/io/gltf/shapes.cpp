// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/shapes.h>

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkGLTFDocumentLoader.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <limits>
#include <utility>

#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/checks.h>
#include <sinew/io/gltf/loader.h>

namespace sinew {
namespace {

/// Adds the triangles of one surface to a soup, and of its vertices those they use.
class Paste {
 public:
  Paste(vtkPoints& points, const GltfShape& shape, int primitive, GltfTriangles& triangles)
      : points_(points),
        shape_(shape),
        primitive_(primitive),
        mirrors_(shape.place.linear().determinant() < 0),
        places_(static_cast<std::size_t>(points.GetNumberOfPoints()), -1),
        triangles_(triangles) {}

  void triangle(vtkIdType a, vtkIdType b, vtkIdType c) {
    if (mirrors_) std::swap(b, c);
    triangles_.soup.polygons.push_back({vertex(a), vertex(b), vertex(c)});
  }

 private:
  int vertex(vtkIdType id) {
    const auto at = static_cast<std::size_t>(id);  // huge if negative
    if (at >= places_.size())
      throw damaged_gltf("a triangle names vertex " + std::to_string(id) + " of " +
                         std::to_string(places_.size()));
    if (places_[at] < 0) add(id, places_[at]);
    return places_[at];
  }

  void add(vtkIdType id, int& place) {
    Vec3 point;
    points_.GetPoint(id, point.data());
    point = shape_.place * point;
    if (!point.allFinite()) throw damaged_gltf("vertex " + std::to_string(id) + " is not finite");
    place = static_cast<int>(triangles_.soup.points.size());
    triangles_.soup.points.push_back(point);
    triangles_.sources.push_back({shape_.node, primitive_, static_cast<int>(id)});
  }

  vtkPoints& points_;
  const GltfShape& shape_;
  int primitive_;
  bool mirrors_;
  std::vector<int> places_;  // of vertices in the soup, -1 for those not used yet
  GltfTriangles& triangles_;
};

template <class Visit>
void for_each_cell(vtkCellArray& cells, const Visit& visit) {
  const auto cell = vtk::TakeSmartPointer(cells.NewIterator());
  for (cell->GoToFirstCell(); !cell->IsDoneWithTraversal(); cell->GoToNextCell()) {
    vtkIdType size;
    const vtkIdType* ids;
    cell->GetCurrentCell(size, ids);
    visit(size, ids);
  }
}

void paste_surface(vtkPolyData& surface, Paste paste) {
  for_each_cell(*surface.GetPolys(),
                [&](vtkIdType, const vtkIdType* ids) { paste.triangle(ids[0], ids[1], ids[2]); });
  for_each_cell(*surface.GetStrips(), [&](vtkIdType size, const vtkIdType* ids) {
    for (vtkIdType i = 0; i + 2 < size; ++i) {
      // Every other triangle turns the other way; flat ones only lead the strip elsewhere.
      const vtkIdType a = ids[i], b = ids[i + 1 + i % 2], c = ids[i + 2 - i % 2];
      if (a != b && b != c && c != a) paste.triangle(a, b, c);
    }
  });
}

void paste_mesh(const vtkGLTFDocumentLoader::Mesh& mesh, const GltfShape& shape,
                GltfTriangles& triangles) {
  for (std::size_t i = 0; i < mesh.Primitives.size(); ++i) {
    vtkPolyData& surface = *mesh.Primitives[i].Geometry;
    paste_surface(surface, Paste(*surface.GetPoints(), shape, static_cast<int>(i), triangles));
  }
}

int mesh_of(const GltfDocument& document, const GltfShape& shape) {
  return document.nodes[static_cast<std::size_t>(shape.node)].mesh;
}

struct Size {
  double vertices = 0, triangles = 0;  // at most
};

Size size_of(const GltfDocument& document, const GltfMesh& mesh) {
  const auto count_of = [&](int accessor) {
    return static_cast<double>(document.accessors[static_cast<std::size_t>(accessor)].count);
  };
  Size size;
  for (const GltfPrimitive& primitive : mesh.primitives) {
    const double vertices = count_of(primitive.positions());
    const double corners = primitive.indices < 0 ? vertices : count_of(primitive.indices);
    size.vertices += vertices;
    size.triangles += primitive.mode == GltfMode::triangles ? corners / 3 : corners - 2;
  }
  return size;
}

/// A small file can place one mesh many thousand times.
void check_size(const GuardedGltf& gltf, const std::vector<GltfShape>& shapes) {
  constexpr double vtk_vertex = 12, vtk_triangle = 32, vertex = 40, triangle = 56;  // bytes
  std::vector<Size> sizes;
  double bytes = 2 * static_cast<double>(gltf.bytes.size());
  for (const GltfMesh& mesh : gltf.document.meshes) {
    sizes.push_back(size_of(gltf.document, mesh));
    bytes += sizes.back().vertices * vtk_vertex + sizes.back().triangles * vtk_triangle;
  }
  Size all;
  for (const GltfShape& shape : shapes) {
    const Size& size = sizes[static_cast<std::size_t>(mesh_of(gltf.document, shape))];
    all.vertices += size.vertices;
    all.triangles += size.triangles;
  }
  bytes += all.vertices * vertex + all.triangles * triangle;
  if (bytes > available_memory() || all.vertices > std::numeric_limits<int>::max())
    throw bad_input("its scene shows " + std::to_string(static_cast<std::int64_t>(all.triangles)) +
                        " triangles, too many for memory",
                    "reduce their number");
}

}  // namespace

GltfTriangles gltf_triangles(const GuardedGltf& gltf, const std::vector<GltfShape>& shapes) {
  check_size(gltf, shapes);
  GltfTriangles triangles;
  if (shapes.empty()) return triangles;
  const auto loader = loaded_gltf(gltf);
  for (const GltfShape& shape : shapes) {
    const int mesh = mesh_of(gltf.document, shape);
    const auto at = static_cast<std::size_t>(mesh);
    try {
      paste_mesh(loader->GetInternalModel()->Meshes[at], shape, triangles);
    } catch (const Error& error) {
      const std::string& name = gltf.document.meshes[at].name;
      throw error.with_context({"mesh " + std::to_string(mesh) + ' ' + shown(name)});
    }
  }
  return triangles;
}

}  // namespace sinew
