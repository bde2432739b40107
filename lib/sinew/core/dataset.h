// SPDX-License-Identifier: GPL-3.0-or-later
// The contents of one file of a series as plain arrays: what writer, reader, renderer and metrics
// exchange. The room io encodes them.
//
//     Dataset data{.points = points};
//     data.point_columns.push_back(column("velocity", velocities));
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

/// A named array of `components` values per point, cell or file.
struct Column {
  std::string name;
  int components = 1;
  std::variant<std::vector<std::int32_t>, std::vector<double>> values;
};

Column column(std::string name, std::vector<std::int32_t> values);
Column column(std::string name, std::vector<double> values);
Column column(std::string name, const Points& vectors);

/// Values that are found piece by piece while they are written, so that no array of millions is
/// made of them. What they are found from must outlive them.
template <class T>
struct Computed {
  std::size_t count = 0;  ///< number of values
  /// Writes values [begin, end) to `to`; called from several threads.
  std::function<void(std::size_t begin, std::size_t end, T* to)> put;
};

struct ComputedColumn {
  std::string name;
  int components = 1;
  std::variant<Computed<std::int32_t>, Computed<double>> values;
};

/// The value is its points per cell.
enum class CellKind { vertex = 1, line = 2, triangle = 3, tetrahedron = 4 };

struct Dataset {
  double time = 0;         ///< s
  std::int32_t cycle = 0;  ///< steps taken so far
  Points points;           ///< n x 3, m
  CellKind kind = CellKind::vertex;
  std::vector<std::int32_t> connectivity;  ///< points of each cell, one cell after the other
  std::vector<std::int32_t> lines;         ///< ends of line cells, which follow those cells
  std::vector<ComputedColumn> computed;    ///< point columns that are written before point_columns
  std::vector<Column> point_columns;
  std::vector<Column> cell_columns;
  std::vector<Column> field_columns;  ///< one row each: values for the whole file
  std::string meta;                   ///< UTF-8 JSON, or empty

  std::size_t cells() const {
    return connectivity.size() / static_cast<std::size_t>(kind) + lines.size() / 2;
  }
};

/// The same with plain columns in place of computed ones.
Dataset evaluated(Dataset data);

/// One vertex cell per point: 0, 1, 2, ...
std::vector<std::int32_t> vertex_cells(std::size_t points);

/// The column of that name, or nullptr.
const Column* find(const std::vector<Column>& columns, std::string_view name);

/// Typed access. Throws bad input, naming the column, where it is missing or of another shape.
const std::vector<std::int32_t>& integers(const std::vector<Column>& columns,
                                          std::string_view name);
const std::vector<double>& numbers(const std::vector<Column>& columns, std::string_view name);
Points vectors(const std::vector<Column>& columns, std::string_view name);

}  // namespace sinew
