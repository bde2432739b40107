// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf/read_gltf.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkGLTFDocumentLoader.h>
#include <vtkMatrix4x4.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <limits>
#include <new>
#include <utility>

#include "core/available_memory.h"
#include "core/error.h"
#include "core/words.h"
#include "io/gltf/guard.h"
#include "io/gltf/loader.h"

namespace sinew {
namespace {

Error damaged(const std::string& what) { return bad_input(what, "export it again"); }

/// Where a node puts its mesh.
struct Placement {
  Mat3 turn = Mat3::Identity();
  Vec3 shift = Vec3::Zero();  // m

  bool mirrors() const { return turn.determinant() < 0; }
};

/// A skinned mesh stands in the scene itself: its joints move it, not its node.
Placement placement_of(const GltfNode& node, const vtkMatrix4x4& global) {
  Placement placement;
  if (node.skin >= 0) return placement;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) placement.turn(i, j) = global.GetElement(i, j);
    placement.shift[i] = global.GetElement(i, 3);
  }
  return placement;
}

/// Adds the triangles of one surface to a soup, and of its vertices those they use.
class Paste {
 public:
  Paste(vtkPoints& points, const Placement& placement, PolygonSoup& soup)
      : points_(points),
        placement_(placement),
        mirrors_(placement.mirrors()),
        places_(static_cast<std::size_t>(points.GetNumberOfPoints()), -1),
        soup_(soup) {}

  void triangle(vtkIdType a, vtkIdType b, vtkIdType c) {
    if (mirrors_) std::swap(b, c);
    soup_.polygons.push_back({vertex(a), vertex(b), vertex(c)});
  }

 private:
  int vertex(vtkIdType id) {
    const auto at = static_cast<std::size_t>(id);  // huge if negative
    if (at >= places_.size())
      throw damaged("a triangle names vertex " + std::to_string(id) + " of " +
                    std::to_string(places_.size()));
    if (places_[at] < 0) add(id, places_[at]);
    return places_[at];
  }

  void add(vtkIdType id, int& place) {
    Vec3 point;
    points_.GetPoint(id, point.data());
    point = placement_.turn * point + placement_.shift;
    if (!point.allFinite()) throw damaged("vertex " + std::to_string(id) + " is not finite");
    place = static_cast<int>(soup_.points.size());
    soup_.points.push_back(point);
  }

  vtkPoints& points_;
  Placement placement_;
  bool mirrors_;
  std::vector<int> places_;  // of vertices in the soup, -1 for those not used yet
  PolygonSoup& soup_;
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

void paste_surface(vtkPolyData& surface, const Placement& placement, PolygonSoup& soup) {
  Paste paste(*surface.GetPoints(), placement, soup);
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

void paste_mesh(const vtkGLTFDocumentLoader::Mesh& mesh, const Placement& placement,
                PolygonSoup& soup) {
  for (const auto& primitive : mesh.Primitives) paste_surface(*primitive.Geometry, placement, soup);
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
void check_size(const GuardedGltf& gltf) {
  constexpr double vtk_vertex = 12, vtk_triangle = 32, vertex = 28, triangle = 56;  // bytes
  std::vector<Size> sizes;
  double bytes = 2 * static_cast<double>(gltf.bytes.size());
  for (const GltfMesh& mesh : gltf.document.meshes) {
    sizes.push_back(size_of(gltf.document, mesh));
    bytes += sizes.back().vertices * vtk_vertex + sizes.back().triangles * vtk_triangle;
  }
  Size all;
  for (const int node : gltf.shown)
    if (const int mesh = gltf.document.nodes[static_cast<std::size_t>(node)].mesh; mesh >= 0) {
      all.vertices += sizes[static_cast<std::size_t>(mesh)].vertices;
      all.triangles += sizes[static_cast<std::size_t>(mesh)].triangles;
    }
  bytes += all.vertices * vertex + all.triangles * triangle;
  const std::string count = std::to_string(static_cast<std::int64_t>(all.triangles));
  if (all.triangles == 0) throw bad_input("its scene shows no triangles", "export it with a mesh");
  if (bytes > available_memory() || all.vertices > std::numeric_limits<int>::max())
    throw bad_input("its scene shows " + count + " triangles, too many for memory",
                    "reduce their number");
}

PolygonSoup soup_of(const GuardedGltf& gltf) {
  check_size(gltf);
  const auto loader = loaded_gltf(gltf);
  const auto model = loader->GetInternalModel();
  PolygonSoup soup;
  for (const int index : gltf.shown) {
    const GltfNode& node = gltf.document.nodes[static_cast<std::size_t>(index)];
    if (node.mesh < 0) continue;
    const auto& global = *model->Nodes[static_cast<std::size_t>(index)].GlobalTransform;
    try {
      paste_mesh(model->Meshes[static_cast<std::size_t>(node.mesh)], placement_of(node, global),
                 soup);
    } catch (const Error& error) {
      const std::string& name = gltf.document.meshes[static_cast<std::size_t>(node.mesh)].name;
      throw error.within({"mesh " + std::to_string(node.mesh) + ' ' + shown(name)});
    }
  }
  return soup;
}

}  // namespace

PolygonSoup read_gltf(const std::filesystem::path& path) {
  try {
    const GuardedGltf gltf = guarded_gltf(path);
    try {
      return soup_of(gltf);
    } catch (const Error& error) {
      throw error.within({path.string()});
    }
  } catch (const std::bad_alloc&) {
    throw bad_input({path.string()}, "it takes more memory than there is",
                    "reduce its number of triangles");
  }
}

}  // namespace sinew
