// SPDX-License-Identifier: GPL-3.0-or-later
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt32Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <fstream>

#include "core/error.h"
#include "core/file.h"
#include "io/arrays.h"
#include "io/vtk_messages.h"
#include "io/vtu.h"

namespace sinew {
namespace {

using ArrayPointer = vtkSmartPointer<vtkDataArray>;

/// Float32 has 24 bits: beyond this many radii a particle would move in steps of a thousandth of r.
constexpr double float32_reach = 1e4;

bool beyond_float32(const Points& points, double radius) {
  return radius > 0 && std::any_of(points.begin(), points.end(), [&](const Vec3& p) {
           return p.cwiseAbs().maxCoeff() > float32_reach * radius;
         });
}

/// VTK's view of values that outlive it, or a copy where it wants another type.
template <class Array, class T>
ArrayPointer filled(const T* values, std::size_t count, int components) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(components);
  using Stored = typename Array::ValueType;
  if constexpr (std::is_same_v<Stored, T>) {
    constexpr int not_owned = 1;
    array->SetArray(const_cast<T*>(values), static_cast<vtkIdType>(count), not_owned);
  } else {
    array->SetNumberOfTuples(static_cast<vtkIdType>(count / components));
    std::transform(values, values + count, array->GetPointer(0),
                   [](T value) { return static_cast<Stored>(value); });
  }
  return array;
}

/// A copy that VTK owns: for values that do not outlive it.
template <class Array, class T>
ArrayPointer copied(const std::vector<T>& values) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

ArrayPointer reals(const double* values, std::size_t count, int components, bool float64) {
  return float64 ? filled<vtkDoubleArray>(values, count, components)
                 : filled<vtkFloatArray>(values, count, components);
}

void describe(vtkDataArray& array, const std::string& name, const WrittenArray* row) {
  array.SetName(name.c_str());
  if (!row) return;
  array.GetInformation()->Set(vtkDataArray::UNITS_LABEL(), std::string(row->unit).c_str());
  for (std::size_t k = 0; k < row->components.size(); ++k)
    array.SetComponentName(static_cast<vtkIdType>(k), std::string(row->components[k]).c_str());
}

ArrayPointer array_of(const Column& column, ArrayPlace place, const VtuFormat& format) {
  const WrittenArray* row = find_written(format.series, place, column.name);
  const bool float64 = format.double_precision || (row && row->numbers == ArrayNumbers::exact);
  ArrayPointer array;
  if (const auto* whole = std::get_if<std::vector<std::int32_t>>(&column.values))
    array = filled<vtkTypeInt32Array>(whole->data(), whole->size(), column.components);
  else if (const auto* real = std::get_if<std::vector<double>>(&column.values))
    array = reals(real->data(), real->size(), column.components, float64);
  describe(*array, column.name, row);
  return array;
}

void add_columns(const std::vector<Column>& columns, ArrayPlace place, const VtuFormat& format,
                 vtkFieldData& to) {
  for (const Column& column : columns) to.AddArray(array_of(column, place, format));
}

void add_attributes(const std::vector<Column>& columns, ArrayPlace place, const VtuFormat& format,
                    vtkDataSetAttributes& to) {
  add_columns(columns, place, format, to);
  for (const Column& column : columns) {
    const WrittenArray* row = find_written(format.series, place, column.name);
    if (row && row->role == ArrayRole::scalars) to.SetActiveScalars(column.name.c_str());
    if (row && row->role == ArrayRole::vectors) to.SetActiveVectors(column.name.c_str());
  }
}

void add_field(const Dataset& data, const VtuFormat& format, vtkFieldData& field) {
  const auto add = [&](const ArrayPointer& array, const char* name) {
    describe(*array, name, find_written(format.series, ArrayPlace::field, name));
    field.AddArray(array);
  };
  add(copied<vtkDoubleArray>(std::vector<double>{data.time}), "TimeValue");
  add(copied<vtkTypeInt32Array>(std::vector<std::int32_t>{data.cycle}), "CYCLE");
  add_columns(data.field_columns, ArrayPlace::field, format, field);
  if (data.meta.empty()) return;
  const auto* bytes = reinterpret_cast<const unsigned char*>(data.meta.data());
  add(filled<vtkUnsignedCharArray>(bytes, data.meta.size(), 1), "sinew_meta");
}

vtkSmartPointer<vtkPoints> points_of(const Dataset& data, const VtuFormat& format) {
  const WrittenArray* row = find_written(format.series, ArrayPlace::point, "Points");
  const bool float64 = format.double_precision || (row && row->numbers == ArrayNumbers::exact) ||
                       beyond_float32(data.points, format.radius);
  const double* first = data.points.empty() ? nullptr : data.points.front().data();
  const ArrayPointer array = reals(first, 3 * data.points.size(), 3, float64);
  describe(*array, "Points", row);
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetData(array);
  return points;
}

int vtk_type(CellKind kind) {
  return kind == CellKind::vertex ? VTK_VERTEX : kind == CellKind::line ? VTK_LINE : VTK_TRIANGLE;
}

/// VTK writes connectivity as wide as the cell array stores it, so it is built on Int32.
void set_cells(const Dataset& data, vtkUnstructuredGrid& grid) {
  const int size = static_cast<int>(data.kind);
  const std::size_t alike = data.connectivity.size() / size;
  std::vector<std::int32_t> offsets(data.cells() + 1);
  std::vector<unsigned char> types(data.cells(), VTK_LINE);
  std::fill_n(types.begin(), alike, static_cast<unsigned char>(vtk_type(data.kind)));
  for (std::size_t i = 1; i < offsets.size(); ++i)
    offsets[i] = offsets[i - 1] + (i <= alike ? size : 2);
  std::vector<std::int32_t> corners = data.connectivity;
  corners.insert(corners.end(), data.lines.begin(), data.lines.end());
  vtkNew<vtkCellArray> cells;
  cells->SetData(vtkTypeInt32Array::SafeDownCast(copied<vtkTypeInt32Array>(offsets)),
                 vtkTypeInt32Array::SafeDownCast(copied<vtkTypeInt32Array>(corners)));
  grid.SetCells(vtkUnsignedCharArray::SafeDownCast(copied<vtkUnsignedCharArray>(types)), cells);
}

vtkSmartPointer<vtkUnstructuredGrid> grid_of(const Dataset& data, const VtuFormat& format) {
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(points_of(data, format));
  set_cells(data, *grid);
  add_attributes(data.point_columns, ArrayPlace::point, format, *grid->GetPointData());
  add_attributes(data.cell_columns, ArrayPlace::cell, format, *grid->GetCellData());
  add_field(data, format, *grid->GetFieldData());
  return grid;
}

/// VTK's writer frees two pointers that it has not set when the disk is full from the start.
class GridWriter : public vtkXMLUnstructuredGridWriter {
 public:
  static GridWriter* New() {
    auto* writer = new GridWriter;
    writer->InitializeObjectBase();
    return writer;
  }

 protected:
  GridWriter() {
    NumberOfPointsPositions = nullptr;
    NumberOfCellsPositions = nullptr;
  }
};

void set_encoding(Encoding encoding, vtkXMLWriter& writer) {
  // Appended data, base64 too, is lost on ParaView 5.11 with an expat of 2024 or later, which Debian 12
  // has by its updates: only data within the elements is safe.
  if (encoding == Encoding::raw) writer.SetDataModeToAppended();
  else writer.SetDataModeToBinary();
  writer.SetHeaderTypeToUInt64();
  writer.SetByteOrderToLittleEndian();
  writer.SetEncodeAppendedData(encoding != Encoding::raw);
  if (encoding == Encoding::zlib) writer.SetCompressorTypeToZLib();
  if (encoding == Encoding::lz4) writer.SetCompressorTypeToLZ4();
  if (encoding == Encoding::raw || encoding == Encoding::none) writer.SetCompressorTypeToNone();
  writer.SetCompressionLevel(1);
}

/// A file cut short by a full disk lacks its last line.
bool ends_well(const std::filesystem::path& path) {
  const std::string last = "</VTKFile>\n";
  std::ifstream file(path, std::ios::binary);
  file.seekg(-static_cast<std::streamoff>(last.size()), std::ios::end);
  std::string end(last.size(), '\0');
  return file.read(end.data(), static_cast<std::streamsize>(end.size())) && end == last;
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const Dataset& data, const VtuFormat& format) {
  const auto grid = grid_of(data, format);
  replace_file(path, [&](const std::filesystem::path& temporary) {
    const VtkMessages messages;
    vtkNew<GridWriter> writer;
    set_encoding(format.encoding, *writer);
    writer->SetInputData(grid);
    writer->SetFileName(temporary.c_str());
    // Write() returns success on a full disk too; the error code tells.
    const bool said_yes = writer->Write() == 1;
    const unsigned long code = writer->GetErrorCode();
    if (said_yes && code == vtkErrorCode::NoError && !messages.failed() && ends_well(temporary))
      return;
    const std::string reason =
        messages.failed() ? messages.first_error() : vtkErrorCode::GetStringFromErrorCode(code);
    throw not_written(path.string(), "cannot be written: " + reason,
                      "free some space or choose another place for the results");
  });
}

}  // namespace sinew
