// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/dataset.h>

#include <numeric>

#include <sinew/core/error.h>

namespace sinew {
namespace {

const Column& require(const std::vector<Column>& columns, std::string_view name, int components) {
  const Column* found = find(columns, name);
  if (!found || found->components != components)
    throw bad_input("there is no array '" + std::string(name) + "' of " +
                        std::to_string(components) + " component(s)",
                    "use a file that sinew has written");
  return *found;
}

template <class T>
const std::vector<T>& values_of(const Column& found, const char* type) {
  if (const auto* values = std::get_if<std::vector<T>>(&found.values)) return *values;
  throw bad_input("array '" + found.name + "' does not hold " + type,
                  "use a file that sinew has written");
}

}  // namespace

Column column(std::string name, std::vector<std::int32_t> values) {
  return {std::move(name), 1, std::move(values)};
}

Column column(std::string name, std::vector<double> values) {
  return {std::move(name), 1, std::move(values)};
}

Column column(std::string name, const Points& vectors) {
  std::vector<double> values;
  values.reserve(3 * vectors.size());
  for (const Vec3& vector : vectors) values.insert(values.end(), vector.data(), vector.data() + 3);
  return {std::move(name), 3, std::move(values)};
}

namespace {

template <class T>
std::vector<T> values_of(const Computed<T>& computed) {
  std::vector<T> values(computed.count);
  computed.put(0, computed.count, values.data());
  return values;
}

}  // namespace

Dataset evaluated(Dataset data) {
  std::vector<Column> columns;
  for (const ComputedColumn& column : data.computed)
    std::visit(
        [&](const auto& computed) {
          columns.push_back({column.name, column.components, values_of(computed)});
        },
        column.values);
  data.computed.clear();
  data.point_columns.insert(data.point_columns.begin(), columns.begin(), columns.end());
  return data;
}

std::vector<std::int32_t> vertex_cells(std::size_t points) {
  std::vector<std::int32_t> cells(points);
  std::iota(cells.begin(), cells.end(), 0);
  return cells;
}

const Column* find(const std::vector<Column>& columns, std::string_view name) {
  for (const Column& candidate : columns)
    if (candidate.name == name) return &candidate;
  return nullptr;
}

const std::vector<std::int32_t>& integers(const std::vector<Column>& columns,
                                          std::string_view name) {
  return values_of<std::int32_t>(require(columns, name, 1), "whole numbers");
}

const std::vector<double>& numbers(const std::vector<Column>& columns, std::string_view name) {
  return values_of<double>(require(columns, name, 1), "numbers");
}

Points vectors(const std::vector<Column>& columns, std::string_view name) {
  const auto& flat = values_of<double>(require(columns, name, 3), "numbers");
  Points points(flat.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = Vec3(&flat[3 * i]);
  return points;
}

}  // namespace sinew
