// SPDX-License-Identifier: GPL-3.0-or-later
#include "given.h"

#include <cstdint>
#include <limits>

#include <sinew/core/error.h>

namespace sinew::python {
namespace {

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t axis = 0; axis < array.ndim(); ++axis)
    text += (axis > 0 ? ", " : "") + std::to_string(array.shape(axis));
  return text + (array.ndim() == 1 ? ",)" : ")");
}

std::string type_text(const py::array& array) { return py::str(array.dtype()); }

/// Any array-like object; null where NumPy makes none of it.
py::array array_of(const py::object& given) {
  return given.is_none() ? py::reinterpret_steal<py::array>(py::handle())
                         : py::array::ensure(given);
}

void refuse_masked(const py::object& given, const std::string& name) {
  if (py::hasattr(given, "mask") &&
      py::cast<bool>(py::module_::import("numpy").attr("ma").attr("is_masked")(given)))
    throw bad_input(name + " are masked", "leave out what is not there, or fill it with numbers");
}

bool is_whole(const py::array& array) {
  return array.dtype().kind() == 'i' || array.dtype().kind() == 'u';
}

using WholeNumbers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

/// Collects polygons and checks their corners.
class Corners {
 public:
  explicit Corners(PolygonSoup& soup) : soup_(soup) {}

  void add(const std::int64_t* corners, py::ssize_t count) {
    const std::string place = "faces[" + std::to_string(soup_.polygons.size()) + ']';
    if (count < 3)
      throw bad_input(place + " has " + std::to_string(count) + " corners", "give 3 or more");
    std::vector<int>& polygon = soup_.polygons.emplace_back(static_cast<std::size_t>(count));
    const auto points = static_cast<std::int64_t>(soup_.points.size());
    for (py::ssize_t i = 0; i < count; ++i) {
      if (corners[i] < 0 || corners[i] >= points)
        throw bad_input(place + " has the corner " + std::to_string(corners[i]),
                        "give indices of vertices, from 0 to " + std::to_string(points - 1));
      polygon[static_cast<std::size_t>(i)] = static_cast<int>(corners[i]);
    }
  }

 private:
  PolygonSoup& soup_;
};

/// Whether each row begins with the number of corners that follow, as in VTK's faces.
bool has_counts(const WholeNumbers& rows) {
  const py::ssize_t count = rows.shape(1) - 1;
  if (count < 3 || rows.shape(0) < 2) return false;
  for (py::ssize_t i = 0; i < rows.shape(0); ++i)
    if (rows.data()[i * rows.shape(1)] != count) return false;
  return true;
}

void add_rows(const WholeNumbers& rows, PolygonSoup& soup) {
  Corners corners(soup);
  soup.polygons.reserve(static_cast<std::size_t>(rows.shape(0)));
  const py::ssize_t first = has_counts(rows) ? 1 : 0;
  for (py::ssize_t i = 0; i < rows.shape(0); ++i)
    corners.add(rows.data() + i * rows.shape(1) + first, rows.shape(1) - first);
  if (first > 0)
    soup.warning = "each of the faces begins with its number of corners, as VTK's do: " +
                   std::to_string(rows.shape(1) - 1) + " is taken for no vertex";
}

/// VTK's form: a number of corners, then the corners.
void add_counted(const WholeNumbers& numbers, PolygonSoup& soup) {
  Corners corners(soup);
  for (py::ssize_t at = 0; at < numbers.size();) {
    const std::int64_t count = numbers.data()[at++];
    if (count < 0 || count > numbers.size() - at)
      throw bad_input("faces in one row are not numbers of corners, each before its corners",
                      "give an array of shape (m, 3), or a list of lists");
    corners.add(numbers.data() + at, static_cast<py::ssize_t>(count));
    at += static_cast<py::ssize_t>(count);
  }
}

[[noreturn]] void refuse_faces(const std::string& what) {
  throw bad_input("faces " + what,
                  "give integers of shape (m, 3) or (m, k), or a list of a list for each polygon");
}

void add_sequence(const py::object& faces, PolygonSoup& soup) {
  if (!py::isinstance<py::sequence>(faces) || py::isinstance<py::str>(faces))
    refuse_faces("are no array");
  Corners corners(soup);
  for (const py::handle& face : faces) {
    const py::array one = array_of(py::reinterpret_borrow<py::object>(face));
    if (!one || one.ndim() != 1 || !is_whole(one))
      refuse_faces("have an entry, faces[" + std::to_string(soup.polygons.size()) +
                   "], that is no list of integers");
    const WholeNumbers whole(one);
    corners.add(whole.data(), whole.size());
  }
}

void add_faces(const py::object& faces, PolygonSoup& soup) {
  refuse_masked(faces, "faces");
  const py::array array = array_of(faces);
  if (!array || array.dtype().kind() == 'O') return add_sequence(faces, soup);
  if (array.size() == 0) throw bad_input("faces are empty", "give at least one polygon");
  if (!is_whole(array)) refuse_faces("are of type " + type_text(array));
  if (array.ndim() == 1) return add_counted(WholeNumbers(array), soup);
  if (array.ndim() != 2 || array.shape(1) < 3) refuse_faces("have the shape " + shape_text(array));
  add_rows(WholeNumbers(array), soup);
}

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

Numbers rows_of_three(const py::object& given, const std::string& name) {
  const py::array array = array_of(given);
  if (!array) throw bad_input(name + " are no array", "give an array of shape (n, 3)");
  refuse_masked(given, name);
  if (array.size() > 0 && array.dtype().kind() != 'f' && !is_whole(array))
    throw bad_input(name + " are of type " + type_text(array), "give numbers, of shape (n, 3)");
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw bad_input(name + " have the shape " + shape_text(array), "give an array of shape (n, 3)");
  return array;
}

/// Refuses what cannot be computed with, but for points that `may_be` takes.
template <class MayBe>
Points checked_points(const Numbers& numbers, const std::string& name, MayBe may_be) {
  Points points(static_cast<std::size_t>(numbers.shape(0)));
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = Eigen::Map<const Vec3>(numbers.data() + 3 * i);
    if (!is_computable(points[i]) && !may_be(points[i]))
      throw bad_input(name + '[' + std::to_string(i) + "] is too large or not finite",
                      "give numbers that can be computed with");
  }
  return points;
}

}  // namespace

Points points_of(const py::object& given, const std::string& name) {
  return checked_points(rows_of_three(given, name), name, [](const Vec3&) { return false; });
}

Points known_points_of(const py::object& given, const std::string& name) {
  return checked_points(rows_of_three(given, name), name,
                        [](const Vec3& point) { return point.hasNaN(); });
}

PolygonSoup polygons_of(const py::object& vertices, const py::object& faces) {
  PolygonSoup soup;
  soup.points = points_of(vertices, "vertices");
  if (soup.points.empty()) throw bad_input("vertices are empty", "give at least three");
  if (soup.points.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw bad_input("vertices are more than 32-bit indices reach", "give fewer");
  if (faces.is_none())
    throw bad_input("faces are missing", "give the polygons of these vertices, as integers");
  add_faces(faces, soup);
  if (soup.polygons.empty()) throw bad_input("faces are empty", "give at least one polygon");
  return soup;
}

py::str text_of(const std::string& text) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "surrogateescape"));
}

std::vector<Override> overrides_of(const Values& values) {
  std::vector<Override> overrides;
  for (const auto& [path, value] : values) overrides.push_back({path, value, path + '=' + value});
  return overrides;
}

}  // namespace sinew::python
