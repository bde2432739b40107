// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays of the library as NumPy's, without copies: a view keeps its owner alive.
//
//     py::array positions = view_of(points, self);
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <utility>
#include <vector>

#include <sinew/sinew.h>
#include "made.h"

namespace sinew::python {

namespace py = pybind11;

/// n x 3 float64, not writable.
inline py::array view_of(const Points& points, const py::object& owner) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  const double* first = points.empty() ? nullptr : points.front().data();
  py::array_t<double> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}}, first,
                            owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// n x 3 int32, not writable.
inline py::array view_of(const std::vector<std::array<int, 3>>& faces, const py::object& owner) {
  const int* first = faces.empty() ? nullptr : faces.front().data();
  py::array_t<int> array({static_cast<py::ssize_t>(faces.size()), py::ssize_t{3}}, first, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// n x 2 int32, not writable.
inline py::array view_of(const std::vector<std::array<int, 2>>& pairs, const py::object& owner) {
  const int* first = pairs.empty() ? nullptr : pairs.front().data();
  py::array_t<int> array({static_cast<py::ssize_t>(pairs.size()), py::ssize_t{2}}, first, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

template <class Value>
py::array view_of(const std::vector<Value>& values, const py::object& owner) {
  py::array_t<Value> array(static_cast<py::ssize_t>(values.size()), values.data(), owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// Hands an array of the library over to NumPy.
template <class Array>
py::array owned(Array values) {
  auto* kept = new Array(std::move(values));
  const py::capsule owner(kept, [](void* array) { delete static_cast<Array*>(array); });
  return view_of(*kept, owner);
}

/// Homogeneous matrices, n x 4 x 4: axes as columns, and the origin.
inline py::array matrices(const std::vector<RigidFrame>& frames) {
  py::array_t<double> all(
      {static_cast<py::ssize_t>(frames.size()), py::ssize_t{4}, py::ssize_t{4}});
  double* to = all.mutable_data();
  for (const RigidFrame& frame : frames) {
    Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows;
    rows.setIdentity();
    rows.topLeftCorner<3, 3>() = frame.rotation;
    rows.topRightCorner<3, 1>() = frame.origin;
    to = std::copy(rows.data(), rows.data() + rows.size(), to);
  }
  return all;
}

/// Its own copy of all that it refers to.
inline std::shared_ptr<Dataset> shared(Dataset data) {
  return std::make_shared<Dataset>(evaluated(std::move(data)));
}

/// A row for each value, as a view of `column`, which `owner` keeps.
inline py::array rows_of(const Column& column, const py::object& owner) {
  py::array flat =
      std::visit([&](const auto& values) { return view_of(values, owner); }, column.values);
  const py::ssize_t components = column.components;
  if (components == 1) return flat;
  py::array rows = flat.attr("reshape")(-1, components);
  return rows;
}

/// The same of a column that nobody else keeps.
inline py::array rows_of(Column column) {
  auto* kept = new Column(std::move(column));
  const py::capsule owner(kept, [](void* all) { delete static_cast<Column*>(all); });
  return rows_of(*kept, owner);
}

// Each file binds its part.

void bind_meshes(py::module_& module);
void bind_datasets(py::module_& module);
void bind_deformation(py::module_& module);
void bind_scenes(py::module_& module);
void bind_inspection(py::module_& module);
void bind_simulation(py::module_& module);
void bind_runs(py::module_& module);

}  // namespace sinew::python
