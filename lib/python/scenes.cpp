// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes, and bodies filled with particles.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>

#include <sinew/core/file.h>
#include <sinew/run/run_folder.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/settings/write_scene.h>
#include "arrays.h"
#include "body.h"
#include "given.h"
#include "without_gil.h"

namespace sinew::python {
namespace {

FilledBody body_of_points(const py::object& given, double radius, std::optional<double> mass,
                          double density) {
  FilledBody body;
  body.points = points_of(given, "points");
  if (body.points.empty()) throw bad_input("a body needs particles", "give at least one point");
  if (!(radius > 0 && is_computable(radius)))
    throw bad_input("the radius is not above 0", "give it in meters");
  body.radius = radius;
  body.mass = mass.value_or(density * volume_per_particle(radius));
  if (!(body.mass > 0 && is_computable(body.mass)))
    throw bad_input("the mass is not above 0", "give it in kilograms");
  return body;
}

void bind_body(py::module_& module) {
  using B = FilledBody;
  const auto view = [](auto B::*member) {
    return [member](const py::object& self) { return view_of(self.cast<B&>().*member, self); };
  };
  py::class_<B, std::shared_ptr<B>>(module, "_Body")
      .def(py::init(&body_of_points))
      .def_property_readonly("points", view(&B::points))
      .def_property_readonly("component", view(&B::component))
      .def_property_readonly("neighbors", view(&B::neighbors))
      .def_property_readonly(
          "vertices",
          [](const py::object& self) { return view_of(self.cast<B&>().surface.points, self); })
      .def_property_readonly(
          "faces",
          [](const py::object& self) { return view_of(self.cast<B&>().surface.faces, self); })
      .def_readonly("_meta", &B::meta)
      .def_readonly("warnings", &B::warnings)
      .def_readonly("radius", &B::radius)
      .def_readonly("mass", &B::mass)
      .def("__len__", [](const B& body) { return body.points.size(); });
}

}  // namespace

void bind_scenes(py::module_& module) {
  bind_body(module);
  py::class_<Settings>(module, "_Scene")
      .def_property_readonly("duration", [](const Settings& s) { return s.solver.duration; })
      .def_property_readonly("interval", [](const Settings& s) { return s.output.interval; })
      .def("__str__",
           [](const Settings& s) { return resolved_scene(s, std::filesystem::current_path()); });
  module.def("_read_scene", [](const std::filesystem::path& path, const Values& values) {
    return read_scene(path, overrides_of(values));
  });
  module.def("_scene_of_text", [](const std::string& text, const std::filesystem::path& folder) {
    return scene_from_text(text, "scene", folder);
  });
  module.def("_presets", [] {
    py::list rows;
    for (const MaterialPreset& one : material_presets())
      rows.append(py::make_tuple(one.name, one.young_modulus, one.density, one.poisson_ratio,
                                 one.damping_ratio, one.yield_strain.value_or(std::nan("")),
                                 one.what, one.source));
    return rows;
  });
  module.def("_write_scene", [](const Settings& given, const std::filesystem::path& folder) {
    const Settings scene = with_mesh_files(given, folder / "meshes");
    create({folder});
    write_mesh_files(scene);
    write_file(folder / "scene.yaml", resolved_scene(scene, folder));
  });
  module.def("_write_file", [](const std::filesystem::path& path, const std::string& content) {
    write_file(path, content);
  });
  module.def("_set_mesh", [](Settings& scene, const SharedPolygons& polygons) {
    scene.meshes[scene.body.mesh] = polygons;
  });
}

}  // namespace sinew::python
