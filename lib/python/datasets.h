// SPDX-License-Identifier: GPL-3.0-or-later
// Data sets as Python has them: their arrays are views.
#pragma once

#include <memory>

#include <sinew/core/dataset.h>
#include "arrays.h"
#include "made.h"

namespace sinew::python {

/// Its own copy of all that it refers to.
inline std::shared_ptr<Dataset> shared(Dataset data) {
  return std::make_shared<Dataset>(evaluated(std::move(data)));
}

/// A row for each value, as a view of `column`, which `owner` keeps.
inline py::array rows_of(const Column& column, const py::object& owner) {
  const py::array flat =
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

}  // namespace sinew::python
