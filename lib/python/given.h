// SPDX-License-Identifier: GPL-3.0-or-later
// What Python gives: arrays of any type, order and owner, and settings, as values of the library.
//
//     const Points points = points_of(given, "points");       // errors name the argument
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/settings/read_scene.h>

namespace sinew::python {

namespace py = pybind11;

/// n x 3 numbers of any type. Throws bad input, naming the argument, for another shape, for what is
/// no number, and for numbers too large to be computed with.
Points points_of(const py::object& given, const std::string& name);

/// The same of points some of which may be unknown: not-a-number.
Points known_points_of(const py::object& given, const std::string& name);

/// The polygons of a mesh: `faces` are m x k integers, a list of lists, or as VTK has them the
/// number of corners before those of each polygon. Throws bad input that names "vertices" or
/// "faces", and the entry, for what cannot be a mesh.
PolygonSoup polygons_of(const py::object& vertices, const py::object& faces);

/// A text of the library, with whatever bytes names of files have.
py::str text_of(const std::string& text);

/// Settings as pairs of a path and YAML: {"body.radius", "0.01"}.
using Values = std::vector<std::pair<std::string, std::string>>;

std::vector<Override> overrides_of(const Values& values);

}  // namespace sinew::python
