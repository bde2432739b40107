// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/vtk/data_sets.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationStringKey.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt32Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <string>

#include <sinew/core/arrays.h>
#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t values_per_piece = 16384;

using AnyArray = vtkSmartPointer<vtkDataArray>;

/// Name, unit and names of components.
void name_array(vtkDataArray& array, const std::string& name, const WrittenArray* row) {
  array.SetName(name.c_str());
  if (row == nullptr) return;
  for (std::size_t k = 0; k < row->components.size(); ++k)
    array.SetComponentName(static_cast<vtkIdType>(k), std::string(row->components[k]).c_str());
  array.GetInformation()->Set(vtkDataArray::UNITS_LABEL(), std::string(row->unit).c_str());
}

/// An array of `count` values, which put(begin, end, to) writes.
template <class Array, class Put>
vtkSmartPointer<Array> filled(std::size_t count, int components, Put&& put) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(count) / components);
  auto* values = array->GetPointer(0);
  parallel_for(count, values_per_piece,
               [&](std::size_t begin, std::size_t end) { put(begin, end, values + begin); });
  return array;
}

template <class Array, class T>
vtkSmartPointer<Array> copied(const std::vector<T>& values, int components = 1) {
  return filled<Array>(values.size(), components,
                       [&](std::size_t begin, std::size_t end, auto* to) {
                         std::copy(values.data() + begin, values.data() + end, to);
                       });
}

/// The values of a column as VTK has them.
struct Values {
  int components;

  AnyArray operator()(const std::vector<std::int32_t>& whole) const {
    return copied<vtkIntArray>(whole, components);
  }
  AnyArray operator()(const std::vector<double>& real) const {
    return copied<vtkDoubleArray>(real, components);
  }
  AnyArray operator()(const Computed<std::int32_t>& whole) const {
    return filled<vtkIntArray>(whole.count, components, whole.put);
  }
  AnyArray operator()(const Computed<double>& real) const {
    return filled<vtkDoubleArray>(real.count, components, real.put);
  }
};

/// The arrays of one place of a data set.
class Arrays {
 public:
  Arrays(vtkFieldData& to, std::string_view series, ArrayPlace place)
      : to_(to), series_(series), place_(place) {}

  template <class AnyColumn>
  vtkDataArray& add(const AnyColumn& column) {
    return add(column.name, std::visit(Values{column.components}, column.values));
  }

  vtkDataArray& add(const std::string& name, const AnyArray& array) {
    const WrittenArray* row = find_written(series_, place_, name);
    name_array(*array, name, row);
    to_.AddArray(array);
    if (auto* attributes = vtkDataSetAttributes::SafeDownCast(&to_)) {
      const ArrayRole role = row ? row->role : ArrayRole::plain;
      if (role == ArrayRole::scalars) attributes->SetActiveScalars(name.c_str());
      if (role == ArrayRole::vectors) attributes->SetActiveVectors(name.c_str());
    }
    return *array;
  }

 private:
  vtkFieldData& to_;
  std::string_view series_;
  ArrayPlace place_;
};

void add_points(const Dataset& data, std::string_view series, vtkPointSet& to) {
  const double* first = data.points.empty() ? nullptr : data.points.front().data();
  const auto coordinates = filled<vtkDoubleArray>(
      3 * data.points.size(), 3, [&](std::size_t begin, std::size_t end, double* out) {
        std::copy(first + begin, first + end, out);
      });
  name_array(*coordinates, "Points", find_written(series, ArrayPlace::point, "Points"));
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  to.SetPoints(points);
  Arrays arrays(*to.GetPointData(), series, ArrayPlace::point);
  for (const ComputedColumn& column : data.computed) arrays.add(column);
  for (const Column& column : data.point_columns) arrays.add(column);
}

void add_fields(const Dataset& data, std::string_view series, vtkDataSet& to) {
  Arrays arrays(*to.GetFieldData(), series, ArrayPlace::field);
  arrays.add("TimeValue", copied<vtkDoubleArray>(std::vector<double>{data.time}));
  arrays.add("CYCLE", copied<vtkIntArray>(std::vector<std::int32_t>{data.cycle}));
  for (const Column& column : data.field_columns) arrays.add(column);
  if (!data.meta.empty())
    arrays.add("sinew_meta",
               copied<vtkUnsignedCharArray>(std::vector<char>(data.meta.begin(), data.meta.end())));
  to.GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), data.time);
}

int type_of(CellKind kind) {
  switch (kind) {
    case CellKind::vertex:
      return VTK_VERTEX;
    case CellKind::line:
      return VTK_LINE;
    case CellKind::triangle:
      return VTK_TRIANGLE;
    case CellKind::tetrahedron:
      return VTK_TETRA;
  }
  return VTK_EMPTY_CELL;
}

/// Cells of `size` points each.
vtkSmartPointer<vtkCellArray> cells_of(const std::vector<std::int32_t>& corners, std::size_t size) {
  const auto offsets = filled<vtkTypeInt32Array>(
      corners.size() / size + 1, 1, [&](std::size_t begin, std::size_t end, std::int32_t* to) {
        for (std::size_t i = begin; i < end; ++i) *to++ = static_cast<std::int32_t>(i * size);
      });
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, copied<vtkTypeInt32Array>(corners));
  return cells;
}

/// Rows of the last `last` cells before the others.
void put_last_first(vtkDataArray& array, std::size_t last) {
  const auto rotate = [&](auto* values) {
    const auto size = array.GetNumberOfValues();
    const auto moved = static_cast<vtkIdType>(last) * array.GetNumberOfComponents();
    std::rotate(values, values + (size - moved), values + size);
  };
  if (auto* whole = vtkIntArray::SafeDownCast(&array)) rotate(whole->GetPointer(0));
  if (auto* real = vtkDoubleArray::SafeDownCast(&array)) rotate(real->GetPointer(0));
}

}  // namespace

vtkSmartPointer<vtkPolyData> vtk_poly_data(const Dataset& data, std::string_view series) {
  auto shape = vtkSmartPointer<vtkPolyData>::New();
  add_points(data, series, *shape);
  std::vector<std::int32_t> lines = data.lines;
  if (data.kind == CellKind::line)
    lines.insert(lines.begin(), data.connectivity.begin(), data.connectivity.end());
  if (!lines.empty()) shape->SetLines(cells_of(lines, 2));
  if (data.kind == CellKind::vertex) shape->SetVerts(cells_of(data.connectivity, 1));
  if (data.kind == CellKind::triangle) shape->SetPolys(cells_of(data.connectivity, 3));
  Arrays arrays(*shape->GetCellData(), series, ArrayPlace::cell);
  const bool lines_come_first = data.kind == CellKind::triangle;
  for (const Column& column : data.cell_columns) {
    vtkDataArray& array = arrays.add(column);
    if (lines_come_first) put_last_first(array, data.lines.size() / 2);
  }
  if (shape->GetPointData()->HasArray("normal")) shape->GetPointData()->SetActiveNormals("normal");
  add_fields(data, series, *shape);
  return shape;
}

vtkSmartPointer<vtkUnstructuredGrid> vtk_grid(const Dataset& data, std::string_view series) {
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  add_points(data, series, *grid);
  const std::size_t alike = data.cells() - data.lines.size() / 2;
  const auto cells = cells_of(data.connectivity, static_cast<std::size_t>(data.kind));
  if (!data.lines.empty()) cells->Append(cells_of(data.lines, 2));
  const auto types = filled<vtkUnsignedCharArray>(
      data.cells(), 1, [&](std::size_t begin, std::size_t end, unsigned char* to) {
        for (std::size_t i = begin; i < end; ++i)
          *to++ = static_cast<unsigned char>(type_of(i < alike ? data.kind : CellKind::line));
      });
  grid->SetCells(types, cells);
  Arrays arrays(*grid->GetCellData(), series, ArrayPlace::cell);
  for (const Column& column : data.cell_columns) arrays.add(column);
  add_fields(data, series, *grid);
  return grid;
}

}  // namespace sinew
