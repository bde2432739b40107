// SPDX-License-Identifier: GPL-3.0-or-later
// Deformation of any points, by their neighbors at rest.
#include "arrays.h"
#include "given.h"

#include <sinew/core/deformation.h>
#include <sinew/core/parallel.h>
#include <sinew/metrics/particle_values.h>

#include "without_gil.h"

namespace sinew::python {
namespace {

/// Refuses more neighbors than there is memory for, by the number that some of the points have.
void refuse_too_many_pairs(const Points& points, double cutoff) {
  constexpr std::size_t asked = 200;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / asked);
  const CellGrid grid(points, cutoff);
  std::vector<std::uint32_t> of_one;
  double pairs = 0;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    of_one.clear();
    append_neighbors(grid, points, i, cutoff, of_one);
    pairs += static_cast<double>(of_one.size() * stride);
  }
  const double needed = pairs * 2 * sizeof(std::uint32_t);  // in pieces, and then together
  if (pairs > UINT32_MAX || needed > available_memory())
    throw bad_input("with a cutoff of " + number_text(cutoff) + " there are some " +
                        three_digits(pairs) + " neighbors, more than there is memory for",
                    "give a smaller cutoff");
}

std::shared_ptr<RestShape> shape_of(const py::object& points, double cutoff) {
  Points at_rest = points_of(points, "points");
  if (!(cutoff > 0) || !std::isfinite(cutoff))
    throw bad_input("the cutoff is " + number_text(cutoff),
                    "give a length above 0: points closer than this are neighbors");
  const WithoutGil free;
  refuse_too_many_pairs(at_rest, cutoff);
  return std::make_shared<RestShape>(rest_shape(std::move(at_rest), cutoff));
}

Points moved_points(const RestShape& rest, const py::object& given) {
  Points now = known_points_of(given, "now");
  if (now.size() != rest.points.size())
    throw bad_input("now are " + std::to_string(now.size()) + " points, and " +
                        std::to_string(rest.points.size()) + " at rest",
                    "give them all, in the same order; not-a-number where one is gone");
  return now;
}

/// F, (n, 3, 3), and D2min, (n,).
py::tuple fits_of(const RestShape& rest, const py::object& given) {
  const Points now = moved_points(rest, given);
  const std::size_t count = now.size();
  const auto rows = static_cast<py::ssize_t>(count);
  py::array_t<double> F({rows, py::ssize_t{3}, py::ssize_t{3}}), D2min(rows);
  double *to = F.mutable_data(), *left = D2min.mutable_data();
  {
    const WithoutGil free;
    parallel_for(count, 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const AffineFit fit = affine_fit(rest, now, i);
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(to + 9 * i) = fit.F;
        left[i] = fit.D2min;
      }
    });
  }
  return py::make_tuple(std::move(F), std::move(D2min));
}

/// Arrays by name, a row for each point.
py::dict deformation_of(const RestShape& rest, const py::object& given) {
  const Points now = moved_points(rest, given);
  std::vector<Column> columns;
  {
    const WithoutGil free;
    columns = deformation_arrays(rest, now);
  }
  py::dict arrays;
  for (Column& one : columns) {
    const std::string name = one.name;
    arrays[py::str(name)] = rows_of(std::move(one));
  }
  return arrays;
}

}  // namespace

void bind_deformation(py::module_& module) {
  py::class_<RestShape, std::shared_ptr<RestShape>>(module, "_RestShape")
      .def(py::init(&shape_of))
      .def("__len__", [](const RestShape& rest) { return rest.points.size(); })
      .def_property_readonly(
          "pairs", [](const RestShape& rest) { return rest.neighbors.neighbor.size() / 2; })
      .def_property_readonly(
          "points",
          [](const py::object& self) { return view_of(self.cast<RestShape&>().points, self); })
      .def("gradients", &fits_of)
      .def("arrays", &deformation_of);
}

}  // namespace sinew::python
