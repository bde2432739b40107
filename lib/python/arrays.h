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

using GivenPoints = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Converts n x 3 numbers. Throws bad input, naming `what`, for another shape.
inline Points points_of(const GivenPoints& given, const std::string& what) {
  if (given.ndim() != 2 || given.shape(1) != 3)
    throw bad_input(what + " are not n x 3 numbers", "give an array of shape (n, 3)");
  Points points(static_cast<std::size_t>(given.shape(0)));
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = Eigen::Map<const Vec3>(given.data() + 3 * i);
  return points;
}

// Each file binds its part.

void bind_scenes(py::module_& module);
void bind_simulation(py::module_& module);
void bind_runs(py::module_& module);

}  // namespace sinew::python
