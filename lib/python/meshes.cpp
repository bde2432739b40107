// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes from arrays: prepared, diagnosed, asked for distances, filled.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <sinew/inspection/mesh_info.h>
#include <sinew/mesh/point_queries.h>
#include "arrays.h"
#include "body.h"
#include "given.h"
#include "made.h"
#include "without_gil.h"

namespace sinew::python {
namespace {

/// The name of a mesh of arrays in errors.
constexpr const char* name_of_arrays = "the mesh";

Settings settings_of_arrays(const SharedPolygons& polygons, const Values& values) {
  Settings settings = settings_of_mesh(name_of_arrays, overrides_of(values));
  settings.meshes[settings.body.mesh] = polygons;
  return settings;
}

FilledBody body_of_filling(Filling filling, Surface surface) {
  FilledBody body;
  body.warnings = filling.report.warnings;
  BodyFile file = body_file(std::move(filling));
  body.points = positions_of(file.particles);
  body.radius = file.particles.radius;
  body.mass = file.particles.mass;
  body.component = std::move(file.component);
  body.neighbors = std::move(file.neighbors);
  if (file.volume_share) body.volume_share = std::move(*file.volume_share);
  if (file.stiffness) body.stiffness = std::move(*file.stiffness);
  body.surface = std::move(surface.triangles);
  body.meta = std::move(file.meta);
  return body;
}

FilledBody fill_settings(const Settings& settings) {
  const WithoutGil free;
  Surface surface = read_mesh(settings);
  Filling filling = fill_body(settings, surface);
  return body_of_filling(std::move(filling), std::move(surface));
}

/// The cells between the particles, up to the surface.
std::shared_ptr<Dataset> tetrahedra_in(const Settings& settings) {
  const WithoutGil free;
  const Surface surface = read_mesh(settings);
  const Filling filling = fill_body(settings, surface);
  return shared(dataset_of(
      cells_of_body(settings, surface, positions_of(filling.particles), filling.particles.radius)));
}

/// The surface as fill() takes it, by options of the section body.
Surface prepared_surface(const SharedPolygons& polygons, Values values) {
  values.emplace_back("body.count", "1000");  // not used, but required of a body
  const WithoutGil free;
  const Settings settings = settings_of_arrays(polygons, values);
  return read_body_mesh(settings.body, settings);
}

template <class Find>
py::array found_at(const py::object& given, const Find& find) {
  const Points points = points_of(given, "points");
  std::vector<double> values;
  {
    const WithoutGil free;
    values = find(points);
  }
  return owned(std::move(values));
}

py::array bytes_of(const std::vector<bool>& flags) {
  py::array_t<bool> array(static_cast<py::ssize_t>(flags.size()));
  std::copy(flags.begin(), flags.end(), array.mutable_data());
  return array;
}

const char* name_of(EdgeDefect defect) {
  switch (defect) {
    case EdgeDefect::open:
      return "open";
    case EdgeDefect::crowded:
      return "crowded";
    default:
      return "twisted";
  }
}

/// Findings as JSON, warnings, and where the defects are.
py::tuple diagnosis_of(const Surface& surface) {
  MeshInfo info;
  {
    const WithoutGil free;
    info = inspect_mesh(surface);
  }
  Defects& defects = info.defects;
  const std::shared_ptr<Dataset> drawing = shared(defects_dataset(drawing_of(surface, defects)));
  if (defects.intersecting.empty()) defects.intersecting.resize(surface.triangles.faces.size());
  std::vector<std::array<int, 2>> edges;
  std::vector<std::int32_t> holes;
  py::list kinds;
  for (const DefectiveEdge& edge : defects.edges) {
    edges.push_back({edge.a, edge.b});
    holes.push_back(edge.hole);
    kinds.append(name_of(edge.defect));
  }
  py::dict where;
  where["_drawing"] = drawing;
  where["turned"] = bytes_of(defects.turned);
  where["intersecting"] = bytes_of(defects.intersecting);
  where["flat"] = bytes_of(defects.flat);
  where["edges"] = owned(std::move(edges));
  where["edge_defects"] = py::module_::import("numpy").attr("array")(kinds, "U7");
  where["holes"] = owned(std::move(holes));
  return py::make_tuple(info.findings.json(), info.warnings, where);
}

py::dict counts_of(const Surface& surface) {
  py::dict counts;
  for (const NamedCount& one : cleaning_counts())
    counts[py::str(std::string(one.name))] = surface.cleaning.*one.count;
  return counts;
}

void bind_surface(py::module_& module) {
  using S = Surface;
  py::class_<S, std::shared_ptr<S>>(module, "_Surface")
      .def_property_readonly(
          "vertices",
          [](const py::object& self) { return view_of(self.cast<S&>().triangles.points, self); })
      .def_property_readonly(
          "faces",
          [](const py::object& self) { return view_of(self.cast<S&>().triangles.faces, self); })
      .def_property_readonly(
          "component",
          [](const py::object& self) { return view_of(self.cast<S&>().component, self); })
      .def_property_readonly("closed", &S::closed)
      .def_property_readonly("changes", &counts_of)
      .def("distance",
           [](const S& surface, const py::object& points) {
             return found_at(points,
                             [&](const Points& at) { return distances(surface.triangles, at); });
           })
      .def("winding_number", [](const S& surface, const py::object& points) {
        return found_at(points, [&](const Points& at) { return winding_numbers(surface, at); });
      });
}

}  // namespace

void bind_meshes(py::module_& module) {
  py::class_<SharedPolygons>(module, "_Polygons").def("__len__", [](const SharedPolygons& mesh) {
    return (*mesh).polygons.size();
  });
  bind_surface(module);
  module.def("_polygons",
             [](const py::object& vertices, const py::object& faces, const std::string& warning) {
               PolygonSoup soup = polygons_of(vertices, faces);
               if (!warning.empty()) soup.warning = warning;
               return SharedPolygons(std::move(soup));
             });
  module.def("_surface", &prepared_surface);
  module.def("_diagnose", &diagnosis_of);
  module.def("_fill", [](const std::filesystem::path& mesh, const Values& values) {
    return fill_settings(settings_of_mesh(mesh, overrides_of(values)));
  });
  module.def("_fill_polygons", [](const SharedPolygons& polygons, const Values& values) {
    return fill_settings(settings_of_arrays(polygons, values));
  });
  module.def("_fill_scene", &fill_settings);
  module.def("_tetrahedra", [](const std::filesystem::path& mesh, const Values& values) {
    return tetrahedra_in(settings_of_mesh(mesh, overrides_of(values)));
  });
  module.def("_tetrahedra_polygons", [](const SharedPolygons& polygons, const Values& values) {
    return tetrahedra_in(settings_of_arrays(polygons, values));
  });
  module.def("_tetrahedra_scene", &tetrahedra_in);
}

}  // namespace sinew::python
