// SPDX-License-Identifier: GPL-3.0-or-later
// Runs on the disk: their frames as arrays, their metrics as columns.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <sinew/io/series_table.h>
#include <sinew/metrics/particle_values.h>
#include <sinew/run/report_input.h>
#include <sinew/run/volume_frames.h>
#include "arrays.h"
#include "without_gil.h"

namespace sinew::python {
namespace {

std::shared_ptr<RunFiles> open(const std::filesystem::path& folder) {
  const WithoutGil free;
  return std::make_shared<RunFiles>(open_run({folder}));
}

/// Ctrl-C and exceptions of the callback end it between two frames.
Measured measured_by(const RunFiles& run, const py::object& progress) {
  struct Ended {};
  Listener listener(progress);
  MeasureOptions how;
  how.progress = [&](std::size_t done, std::size_t of) {
    listener.report(done, of);
    if (listener.ended()) throw Ended();
  };
  try {
    const WithoutGil free;
    return measure_run(run, how);
  } catch (const Ended&) {
    listener.raise();
    throw;
  }
}

py::dict measure(const RunFiles& run, const py::object& progress) {
  const Measured measured = measured_by(run, progress);
  py::dict columns;
  for (const Metric& metric : metrics_table()) {
    std::vector<double> values;
    for (const FrameMetrics& frame : measured.frames) values.push_back(frame.*metric.value);
    columns[py::str(std::string(metric.name))] = owned(std::move(values));
  }
  return columns;
}

/// Measures a run into its folder, with the report.
std::filesystem::path report(const RunFiles& run, const py::object& progress) {
  Measured measured = measured_by(run, progress);
  const WithoutGil free;
  write_tables(run, measured);
  write_report(run, std::move(measured), MovieLink::if_there);
  return run.folder.path / "report.html";
}

py::dict units_of_metrics() {
  py::dict units;
  for (const Metric& metric : metrics_table())
    units[py::str(std::string(metric.name))] = std::string(metric.unit);
  return units;
}

std::shared_ptr<FrameState> frame_of(const RunFiles& run, std::size_t index) {
  const WithoutGil free;
  return std::make_shared<FrameState>(read_frame(run, index));
}

/// The arrays of particles that positions define, in any frame of a run.
class RunMeter {
 public:
  explicit RunMeter(std::shared_ptr<RunFiles> run) : run_(std::move(run)), rest_(rest_of(*run_)) {}

  Column array(const FrameState& frame, const std::string& name) const {
    const RequestedArrays asked = requested_arrays(name);
    if (!asked.stepped.empty())
      throw bad_input(shown(name) + " is known while a run steps, and this one has not written it",
                      "run the scene with output.arrays: " + name);
    if (asked.measured.size() != 1)
      throw bad_input(shown(name) + " names " + std::to_string(asked.measured.size()) + " arrays",
                      "name one, such as stress");
    std::vector<Column> found = particle_arrays(rest_, frame, asked.measured);
    return std::move(found.front());
  }

 private:
  std::shared_ptr<RunFiles> run_;
  RestBody rest_;
};

/// The cells between the particles of a run, in any frame.
class RunCells {
 public:
  explicit RunCells(std::shared_ptr<RunFiles> run) : run_(std::move(run)), cells_(*run_) {}

  std::shared_ptr<Dataset> at(std::size_t index, const Dataset& particles) const {
    return shared(cells_.at(index, particles));
  }

 private:
  std::shared_ptr<RunFiles> run_;
  RunVolume cells_;
};

void simulate_into(const Settings& scene, const std::filesystem::path& folder, bool force,
                   bool resume, const py::object& progress) {
  Listener listener(progress);
  SimulateOptions options;
  options.force = force, options.resume = resume;
  options.command = {"sinew.simulate"};
  options.stop_requested = [&] { return listener.ended(); };
  options.progress = [&](const RunProgress& at) {
    listener.report(static_cast<std::size_t>(at.frame), static_cast<std::size_t>(at.frames));
  };
  {
    const WithoutGil free;
    try {
      simulate(scene, {folder}, options);
    } catch (const Error& error) {
      if (error.exit() != Exit::interrupted) throw;
    }
  }
  listener.raise();
}

void bind_frame(py::module_& module) {
  using F = FrameState;
  const auto view = [](auto F::*member) {
    return [member](const py::object& self) { return view_of(self.cast<F&>().*member, self); };
  };
  py::class_<F, std::shared_ptr<F>>(module, "_Frame")
      .def_readonly("time", &F::time)
      .def_property_readonly("positions", view(&F::positions))
      .def_property_readonly("velocities", view(&F::velocities))
      .def_property_readonly("surface", view(&F::surface_points))
      .def_property_readonly("von_mises", view(&F::von_mises))
      .def_property_readonly("broken_bonds", view(&F::broken_bonds))
      .def_property_readonly("bone_frames", [](const F& frame) { return matrices(frame.bones); });
}

template <class Made>
auto made_without_gil() {
  return py::init([](std::shared_ptr<RunFiles> run) {
    const WithoutGil free;
    return std::make_unique<Made>(std::move(run));
  });
}

void bind_measures(py::module_& module) {
  py::class_<RunMeter>(module, "_RunMeter")
      .def(made_without_gil<RunMeter>())
      .def("array", [](const RunMeter& meter, const FrameState& frame, const std::string& name) {
        Column found;
        {
          const WithoutGil free;
          found = meter.array(frame, name);
        }
        return rows_of(std::move(found));
      });
  py::class_<RunCells>(module, "_RunCells")
      .def(made_without_gil<RunCells>())
      .def("at", &RunCells::at, py::call_guard<WithoutGil>());
}

}  // namespace

void bind_runs(py::module_& module) {
  using R = RunFiles;
  bind_frame(module);
  bind_measures(module);
  py::class_<R, std::shared_ptr<R>>(module, "_Run")
      .def("__len__", &R::frames)
      .def("frame", &frame_of)
      .def_property_readonly("folder", [](const R& run) { return run.folder.path; })
      .def_property_readonly("scene", [](const R& run) { return run.settings; })
      .def_property_readonly("bones",
                             [](const R& run) {
                               std::vector<std::string> names;
                               for (const Bone& bone : run.skeleton.bones)
                                 names.push_back(bone.name);
                               return names;
                             })
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
  module.def("_series_in", [](const std::filesystem::path& folder) {
    const auto names = series_in(folder);
    return std::vector<std::string>(names.begin(), names.end());
  });
  module.def("_open_run", &open);
  module.def("_measure", &measure);
  module.def("_report", &report);
  module.def("_units_of_metrics", &units_of_metrics);
  module.def("_simulate", &simulate_into);
}

}  // namespace sinew::python
