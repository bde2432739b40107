// SPDX-License-Identifier: GPL-3.0-or-later
// Runs on the disk: their frames as arrays, their metrics as columns.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.h"
#include "without_gil.h"

namespace sinew::python {
namespace {

std::shared_ptr<RunFiles> open(const std::filesystem::path& folder) {
  return std::make_shared<RunFiles>(open_run({folder}));
}

py::dict measure(const std::filesystem::path& folder) {
  Measured measured;
  {
    const WithoutGil free;
    const RunFiles run = open_run({folder});
    measured = measure_run(run, {});
  }
  py::dict columns;
  for (const Metric& metric : metrics_table()) {
    std::vector<double> values;
    for (const FrameMetrics& frame : measured.frames) values.push_back(frame.*metric.value);
    columns[py::str(std::string(metric.name))] = owned(std::move(values));
  }
  return columns;
}

std::shared_ptr<RunFrame> frame_of(const RunFiles& run, std::int64_t index) {
  const auto frames = static_cast<std::int64_t>(run.frames());
  if (index < 0) index += frames;
  if (index < 0 || index >= frames) throw py::index_error("there is no such frame");
  const WithoutGil free;
  return std::make_shared<RunFrame>(read_frame(run, static_cast<std::size_t>(index)));
}

void simulate_into(const Settings& scene, const std::filesystem::path& folder, bool force,
                   bool resume) {
  SimulateOptions options;
  options.force = force, options.resume = resume;
  options.command = {"sinew.simulate"};
  bool interrupted = false;
  Stopwatch since_asked;
  const bool hears_signals = is_main_thread();
  options.stop_requested = [&] {  // after every step
    if (leaving) return true;
    if (!hears_signals || interrupted || since_asked.seconds() < 0.05) return interrupted;
    since_asked.lap();
    const py::gil_scoped_acquire acquire;
    return interrupted = PyErr_CheckSignals() != 0;
  };
  {
    const WithoutGil free;
    simulate(scene, {folder}, options);
  }
  if (interrupted) throw py::error_already_set();
}

void bind_frame(py::module_& module) {
  using F = RunFrame;
  const auto view = [](auto F::*member) {
    return [member](const py::object& self) { return view_of(self.cast<F&>().*member, self); };
  };
  py::class_<F, std::shared_ptr<F>>(module, "Frame")
      .def_readonly("time", &F::time)
      .def_property_readonly("positions", view(&F::positions))
      .def_property_readonly("velocities", view(&F::velocities))
      .def_property_readonly("displacement", view(&F::displacement))
      .def_property_readonly("surface", view(&F::surface_points))
      .def_property_readonly("von_mises", view(&F::von_mises))
      .def_property_readonly("broken_bonds", view(&F::broken_bonds));
}

}  // namespace

void bind_runs(py::module_& module) {
  using R = RunFiles;
  bind_frame(module);
  py::class_<R, std::shared_ptr<R>>(module, "Run")
      .def("__len__", &R::frames)
      .def("__getitem__", &frame_of)
      .def_property_readonly("folder", [](const R& run) { return run.folder.path; })
      .def_property_readonly("times",
                             [](const R& run) {
                               std::vector<double> times;
                               for (const PvdRow& row : run.particle_rows)
                                 times.push_back(row.time);
                               return owned(std::move(times));
                             })
      .def_property_readonly("rest",
                             [](const R& run) { return owned(positions_of(run.body.particles)); })
      .def_property_readonly("radius", [](const R& run) { return run.body.particles.radius; })
      .def_property_readonly("faces", [](const py::object& self) {
        return view_of(self.cast<R&>().surface.faces, self);
      });
  module.def("open_run", &open, py::arg("folder"));
  module.def("measure", &measure, py::arg("folder"));
  module.def("_simulate", &simulate_into);
}

}  // namespace sinew::python
