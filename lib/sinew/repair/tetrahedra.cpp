// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/make_mesh_3.h>

#include <sinew/core/error.h>
#include <sinew/repair/self_intersections.h>
#include <sinew/repair/volume_meshing.h>

#include <unordered_map>
#include <utility>

namespace sinew {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Skin = CGAL::Surface_mesh<Kernel::Point_3>;
using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel, Skin>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index,
                                                        Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

constexpr double sharp = 30;               // degrees, between the normals at an edge
constexpr double surface_fraction = 0.05;  // distance of faces from the surface, over the size
constexpr double min_face_angle = 25;      // degrees
constexpr double max_slender = 2.5;        // radius of the sphere around over the shortest edge

Skin skin_of(const Triangles& surface) {
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> faces;
  for (const Vec3& p : surface.points) points.emplace_back(p.x(), p.y(), p.z());
  for (const auto& [a, b, c] : surface.faces)
    faces.push_back(
        {static_cast<std::size_t>(a), static_cast<std::size_t>(b), static_cast<std::size_t>(c)});
  namespace pmp = CGAL::Polygon_mesh_processing;
  if (!pmp::is_polygon_soup_a_polygon_mesh(faces))
    throw bad_input("the surface has edges of three faces or more",
                    "repair the mesh, or set body.wrap");
  Skin skin;
  pmp::polygon_soup_to_polygon_mesh(points, faces, skin);
  return skin;
}

VolumeMesh mesh_of(const Complex& complex) {
  VolumeMesh mesh;
  std::unordered_map<Triangulation::Vertex_handle, std::uint32_t> number;
  const Triangulation& all = complex.triangulation();
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end();
       ++cell) {
    VolumeElement element;
    for (int k = 0; k < 4; ++k) {
      const auto vertex = cell->vertex(k);
      const auto [found, fresh] =
          number.try_emplace(vertex, static_cast<std::uint32_t>(mesh.nodes.size()));
      const auto& p = all.point(vertex);
      if (fresh)
        mesh.nodes.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()),
                                CGAL::to_double(p.z()));
      element.nodes[static_cast<std::size_t>(k)] = found->second;
    }
    if (volume_of(mesh, element) < 0) std::swap(element.nodes[0], element.nodes[1]);
    mesh.elements.push_back(element);
  }
  return second_order(std::move(mesh));
}

}  // namespace

VolumeMesh tetrahedra(const Triangles& surface, double size) {
  if (self_intersections(surface, 1).pairs > 0)
    throw bad_input("the surface intersects itself", "repair the mesh, or set body.wrap");
  const Skin skin = skin_of(surface);
  if (!CGAL::is_closed(skin))
    throw bad_input("the surface is open", "set body.close_holes, or body.wrap");
  CGAL::Random random(0);  // the same mesh each time
  Domain domain(skin, &random);
  domain.detect_features(sharp);
  namespace parameters = CGAL::parameters;
  const Criteria criteria(
      parameters::edge_size = size, parameters::facet_angle = min_face_angle,
      parameters::facet_size = size, parameters::facet_distance = surface_fraction * size,
      parameters::cell_radius_edge_ratio = max_slender, parameters::cell_size = size);
  const auto complex = CGAL::make_mesh_3<Complex>(domain, criteria);
  VolumeMesh mesh = mesh_of(complex);
  if (mesh.elements.empty())
    throw bad_input("no tetrahedron of that size lies in the body", "give a smaller --size");
  return mesh;
}

}  // namespace sinew
