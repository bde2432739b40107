// SPDX-License-Identifier: GPL-3.0-or-later
#include <vtkAOSDataArrayTemplate.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArraySelection.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <algorithm>
#include <limits>
#include <optional>
#include <type_traits>

#include <sinew/core/error.h>
#include <sinew/io/vtk_messages.h>
#include <sinew/io/vtu.h>
#include <sinew/io/vtu_header.h>
#include <sinew/io/vtu_lines.h>

namespace sinew {
namespace {

Error refused(const std::string& what) {
  return bad_input(what, "use a VTU file as sinew writes them");
}

bool fits_int32(vtkDataArray& array) {
  const int type = array.GetDataType();
  if (type == VTK_FLOAT || type == VTK_DOUBLE) return false;
  if (array.GetDataTypeSize() < 4 || type == VTK_INT) return true;
  using Limits = std::numeric_limits<std::int32_t>;
  for (int k = 0; k < array.GetNumberOfComponents(); ++k) {
    double range[2];
    array.GetRange(range, k);
    if (array.GetNumberOfTuples() > 0 && (range[0] < Limits::min() || range[1] > Limits::max()))
      return false;
  }
  return true;
}

template <class Value>
using Typed = vtkAOSDataArrayTemplate<Value>;

template <class Value, class Given>
std::vector<Value> converted_values(Typed<Given>& array) {
  const Given* first = array.GetPointer(0);
  return {first, first + array.GetNumberOfValues()};
}

template <class Value>
std::vector<Value> values_of(vtkDataArray& array) {
  // What our own files hold, without a copy between.
  if (auto* same = Typed<Value>::FastDownCast(&array)) return converted_values<Value>(*same);
  if (auto* reals = Typed<float>::FastDownCast(&array); reals && std::is_same_v<Value, double>)
    return converted_values<Value>(*reals);
  vtkNew<Typed<Value>> converted;
  converted->DeepCopy(&array);
  return converted_values<Value>(*converted);
}

Column column_of(vtkDataArray& array) {
  Column column{array.GetName() ? array.GetName() : "", array.GetNumberOfComponents(), {}};
  if (fits_int32(array))
    column.values = values_of<std::int32_t>(array);
  else
    column.values = values_of<double>(array);
  return column;
}

/// The arrays of one kind of place, each `rows` long.
std::vector<Column> columns_of(vtkFieldData& from, vtkIdType rows) {
  std::vector<Column> columns;
  for (int i = 0; i < from.GetNumberOfArrays(); ++i) {
    vtkDataArray* array = from.GetArray(i);
    const char* name = from.GetAbstractArray(i)->GetName();
    if (!array) throw refused("array '" + std::string(name ? name : "") + "' is not numeric");
    if (array->GetNumberOfTuples() != rows)
      throw refused("array '" + std::string(name ? name : "") + "' has the wrong length");
    columns.push_back(column_of(*array));
  }
  return columns;
}

Points points_of(vtkUnstructuredGrid& grid) {
  if (!grid.GetPoints()) return {};
  const auto flat = values_of<double>(*grid.GetPoints()->GetData());
  Points points;
  points.reserve(flat.size() / 3);
  for (std::size_t i = 0; i + 2 < flat.size(); i += 3) points.emplace_back(&flat[i]);
  return points;
}

CellKind kind_of(vtkUnstructuredGrid& grid) {
  const vtkUnsignedCharArray* types = grid.GetCellTypesArray();
  if (grid.GetNumberOfCells() == 0 || !types) return CellKind::vertex;
  const unsigned char type = types->GetValue(0);
  for (vtkIdType i = 1; i < types->GetNumberOfValues(); ++i)
    if (types->GetValue(i) != type) throw refused("its cells are not all of one kind");
  if (type == VTK_VERTEX) return CellKind::vertex;
  if (type == VTK_LINE) return CellKind::line;
  if (type == VTK_TRIANGLE) return CellKind::triangle;
  throw refused("it holds cells of VTK's type " + std::to_string(type) +
                ", not vertices, lines or triangles");
}

/// Checked here because VTK believes what the file says: every cell of `size` points, all existing.
std::vector<std::int32_t> connectivity_of(vtkUnstructuredGrid& grid, int size) {
  vtkCellArray& cells = *grid.GetCells();
  const auto offsets = values_of<double>(*cells.GetOffsetsArray());
  for (std::size_t i = 0; i < offsets.size(); ++i)
    if (offsets[i] != static_cast<double>(i) * size)
      throw refused("a cell does not have " + std::to_string(size) + " point(s)");
  const auto ids = values_of<double>(*cells.GetConnectivityArray());
  if (ids.size() != static_cast<std::size_t>(grid.GetNumberOfCells()) * size)
    throw refused("its cells are cut short");
  for (const double id : ids)
    if (!(id >= 0 && id < static_cast<double>(grid.GetNumberOfPoints())))
      throw refused("a cell names a point that is not there");
  return {ids.begin(), ids.end()};
}

void take_field(vtkFieldData& field, Dataset& data) {
  for (int i = 0; i < field.GetNumberOfArrays(); ++i) {
    vtkDataArray* array = field.GetArray(i);
    if (!array) throw refused("its field data is not numeric");
    Column column = column_of(*array);
    const bool single = array->GetNumberOfValues() == 1;
    if (column.name == "TimeValue" && single)
      data.time = array->GetComponent(0, 0);
    else if (column.name == "CYCLE" && single && fits_int32(*array))
      data.cycle = static_cast<std::int32_t>(array->GetComponent(0, 0));
    else if (auto* bytes = vtkUnsignedCharArray::SafeDownCast(array);
             bytes && column.name == "sinew_meta")
      data.meta.assign(reinterpret_cast<const char*>(bytes->GetPointer(0)),
                       static_cast<std::size_t>(bytes->GetNumberOfValues()));
    else {
      column.components = static_cast<int>(array->GetNumberOfValues());
      data.field_columns.push_back(std::move(column));
    }
  }
}

Dataset dataset_of(vtkUnstructuredGrid& grid) {
  Dataset data;
  data.points = points_of(grid);
  data.kind = kind_of(grid);
  if (grid.GetNumberOfCells() > 0)
    data.connectivity = connectivity_of(grid, static_cast<int>(data.kind));
  data.point_columns = columns_of(*grid.GetPointData(), grid.GetNumberOfPoints());
  data.cell_columns = columns_of(*grid.GetCellData(), grid.GetNumberOfCells());
  take_field(*grid.GetFieldData(), data);
  return data;
}

using Names = std::initializer_list<const char*>;

/// Lets the reader pass over all arrays of the points but those named.
void select(vtkXMLUnstructuredGridReader& reader, const Names& names) {
  reader.UpdateInformation();
  vtkDataArraySelection& selection = *reader.GetPointDataArraySelection();
  selection.DisableAllArrays();
  for (const char* name : names)
    if (selection.ArrayExists(name)) selection.EnableArray(name);
}

/// All arrays of the points where `names` is none.
Dataset read_checked(const std::filesystem::path& path, const std::optional<Names>& names) {
  if (auto ours = read_vtu_lines(path, names)) return *std::move(ours);
  const VtkMessages messages;
  check_vtu_header(path);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  if (names) select(*reader, *names);
  reader->Update();
  if (messages.failed()) throw refused("it cannot be read: " + messages.first_error());
  if (reader->GetErrorCode() != 0 || !reader->GetOutput())
    throw refused("it cannot be read, it may be cut short");
  return dataset_of(*reader->GetOutput());
}

void check_points(const Points& points) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite()) throw refused("point " + std::to_string(i) + " is not finite");
}

Dataset read_with_context(const std::filesystem::path& path, const std::optional<Names>& names) {
  try {
    Dataset data = read_checked(path, names);
    check_points(data.points);
    return data;
  } catch (const Error& error) {
    throw error.with_context({path.string()});
  } catch (const std::exception&) {
    // What VTK throws when it believes a wrong count: out of memory, a vector too long.
    throw refused("its counts do not fit its size").with_context({path.string()});
  }
}

}  // namespace

Dataset read_vtu(const std::filesystem::path& path) { return read_with_context(path, std::nullopt); }

Dataset read_vtu(const std::filesystem::path& path,
                 std::initializer_list<const char*> point_arrays) {
  return read_with_context(path, point_arrays);
}

}  // namespace sinew
