// SPDX-License-Identifier: GPL-3.0-or-later
// Data sets: the files of a series, or what such a file would hold of a simulation.
#include "arrays.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "without_gil.h"

namespace sinew::python {
namespace {

std::shared_ptr<Dataset> read_file_of_series(const std::filesystem::path& path) {
  const WithoutGil free;
  return shared(read_vtu(path));
}

/// Arrays by name.
py::dict arrays_of(const std::vector<Column>& columns, const py::object& owner) {
  py::dict arrays;
  for (const Column& one : columns) arrays[py::str(one.name)] = rows_of(one, owner);
  return arrays;
}

py::dict units_of(const std::string& series, const Dataset& data) {
  py::dict units;
  const auto add = [&](ArrayPlace place, const std::vector<Column>& columns) {
    for (const Column& one : columns)
      if (const WrittenArray* row = find_written(series, place, one.name))
        units[py::str(one.name)] = std::string(row->unit);
  };
  add(ArrayPlace::point, data.point_columns);
  add(ArrayPlace::cell, data.cell_columns);
  add(ArrayPlace::field, data.field_columns);
  return units;
}

py::array rows_of_ids(const std::vector<std::int32_t>& ids, int each, const py::object& owner) {
  return view_of(ids, owner).attr("reshape")(-1, each);
}

std::vector<std::pair<double, std::filesystem::path>> rows_of_pvd(
    const std::filesystem::path& path) {
  std::vector<std::pair<double, std::filesystem::path>> rows;
  for (const PvdRow& row : read_pvd(path))
    rows.emplace_back(row.time, path.parent_path() / row.file);
  return rows;
}

}  // namespace

void bind_datasets(py::module_& module) {
  using D = Dataset;
  const auto columns = [](auto member) {
    return [member](const py::object& self) { return arrays_of(self.cast<D&>().*member, self); };
  };
  py::class_<D, std::shared_ptr<D>>(module, "_Dataset")
      .def_readonly("time", &D::time)
      .def_readonly("cycle", &D::cycle)
      .def_property_readonly(
          "points", [](const py::object& self) { return view_of(self.cast<D&>().points, self); })
      .def_property_readonly("cells",
                             [](const py::object& self) {
                               const D& data = self.cast<D&>();
                               return rows_of_ids(data.connectivity, static_cast<int>(data.kind),
                                                  self);
                             })
      .def_property_readonly(
          "lines",
          [](const py::object& self) { return rows_of_ids(self.cast<D&>().lines, 2, self); })
      .def_property_readonly("point_arrays", columns(&D::point_columns))
      .def_property_readonly("cell_arrays", columns(&D::cell_columns))
      .def_property_readonly("field_arrays", columns(&D::field_columns))
      .def_property_readonly("_meta", [](const D& data) { return py::bytes(data.meta); });
  module.def("_read_vtu", &read_file_of_series);
  module.def("_read_pvd", &rows_of_pvd);
  module.def("_units", &units_of);
}

}  // namespace sinew::python
