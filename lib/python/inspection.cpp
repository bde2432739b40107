// SPDX-License-Identifier: GPL-3.0-or-later
// What the commands new, info and check do.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <sinew/inspection/check.h>
#include <sinew/inspection/info.h>
#include <sinew/scene/new/new_scene.h>
#include "arrays.h"
#include "given.h"
#include "made.h"
#include "without_gil.h"

namespace sinew::python {
namespace {

py::tuple info(const std::filesystem::path& path, const Values& values,
               std::optional<double> radius, bool verify, const std::string& drawing) {
  Info found;
  {
    const WithoutGil free;
    found = info_of({path.string(), overrides_of(values), radius, verify, drawing});
  }
  if (found.damage) throw Error(*found.damage);
  return py::make_tuple(found.findings.json(), found.warnings);
}

py::tuple check(const Settings& scene, const std::filesystem::path& folder) {
  SceneCheck found;
  {
    const WithoutGil free;
    found = check_scene(prepare({scene}), folder);
  }
  return py::make_tuple(found.findings.json(), found.warnings);
}

py::dict make_scene_of(const NewSceneWish& wish) {
  WrittenScene written;
  {
    const WithoutGil free;
    written = write_new_scene(wish);
  }
  py::dict found;
  found["path"] = text_of(written.path);
  found["mesh"] = text_of(written.mesh);
  found["unit"] = written.scene.unit;
  found["up"] = written.scene.axes;
  found["bones"] = written.scene.bones;
  found["rest"] = written.scene.pose;
  found["size"] = written.scene.size;
  found["time"] = written.scene.time;
  found["warning"] = written.scene.warning;
  return found;
}

}  // namespace

void bind_inspection(py::module_& module) {
  module.def("_info", &info);
  module.def("_check", &check);
  module.def("_new", [](const std::filesystem::path& mesh, const std::filesystem::path& rig,
                        const std::filesystem::path& scene, bool force, bool quick) {
    return make_scene_of({mesh.string(), rig.string(), scene.string(), {}, force, {}, {}, quick});
  });
  module.def("_new_of_polygons", [](const SharedPolygons& polygons,
                                    const std::filesystem::path& rig,
                                    const std::filesystem::path& scene, bool force, bool quick) {
    return make_scene_of({"mesh", rig.string(), scene.string(), {}, force, *polygons, {}, quick});
  });
}

}  // namespace sinew::python
