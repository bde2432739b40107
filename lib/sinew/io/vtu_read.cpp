// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <new>
#include <optional>

#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/io/detail/vtk_xml.h>
#include <sinew/io/detail/vtu_array.h>
#include <sinew/io/vtu.h>

namespace sinew {
namespace {

constexpr double text_only = 1;  // memory per byte; arrays ask for theirs

using Names = std::initializer_list<const char*>;

struct VtuFile : VtkXmlFile {
  explicit VtuFile(std::string_view text) : VtkXmlFile(vtk_xml_file(text)) {
    if (type != "UnstructuredGrid")
      throw vtu_refused("it holds " + shown(type) + ", not an UnstructuredGrid");
  }
};

/// The elements of one of its pieces.
struct VtuPiece {
  const VtuFile& file;
  std::span<const XmlElement> elements;

  const VtuArrays& arrays() const { return file.arrays; }
  std::vector<const XmlElement*> group(const std::string& name) const {
    return file.arrays_in(elements, name);
  }
};

/// The integers of one of the arrays that make up the cells.
std::vector<std::int32_t> of_cells(const VtuPiece& piece, const char* name, std::uint64_t count) {
  for (const XmlElement* array : piece.group("Piece/Cells")) {
    if (array->attribute("Name") != name) continue;
    Column column = piece.arrays().column(*array, count);
    if (auto* integers = std::get_if<std::vector<std::int32_t>>(&column.values))
      return std::move(*integers);
    throw vtu_refused("array " + quoted(name) + " does not hold integers of 32 bits");
  }
  throw vtu_refused("its cells have no " + std::string(name));
}

CellKind kind_of(const std::vector<std::int32_t>& types) {
  for (const std::int32_t type : types)
    if (type != types.front()) throw vtu_refused("its cells are not all of one kind");
  // One after the other: a loop over a list of kinds finds none where GCC 12 compiles for ARM64.
  const std::int32_t type = types.front();
  if (type == vtk_type(CellKind::vertex)) return CellKind::vertex;
  if (type == vtk_type(CellKind::line)) return CellKind::line;
  if (type == vtk_type(CellKind::triangle)) return CellKind::triangle;
  if (type == vtk_type(CellKind::tetrahedron)) return CellKind::tetrahedron;
  throw vtu_refused("it holds cells of VTK's type " + std::to_string(type) +
                    ", not vertices, lines, triangles or tetrahedra");
}

void read_cells(const VtuPiece& piece, std::uint64_t cells, Dataset& data) {
  if (cells == 0) return;
  data.kind = kind_of(of_cells(piece, "types", cells));
  const auto size = static_cast<std::int64_t>(data.kind);
  const auto ends = of_cells(piece, "offsets", cells);
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (ends[i] != static_cast<std::int64_t>(i + 1) * size)
      throw vtu_refused("a cell does not have " + std::to_string(size) + " point(s)");
  data.connectivity = of_cells(piece, "connectivity", cells * static_cast<std::uint64_t>(size));
  for (const std::int32_t id : data.connectivity)
    if (id < 0 || static_cast<std::size_t>(id) >= data.points.size())
      throw vtu_refused("a cell names a point that is not there");
}

void read_points(const VtuPiece& piece, std::uint64_t points, Dataset& data) {
  const auto arrays = piece.group("Piece/Points");
  if (points == 0) return;
  if (arrays.size() != 1) throw vtu_refused("its points are not one array");
  data.points = piece.arrays().points(*arrays.front(), points);
  for (std::size_t i = 0; i < data.points.size(); ++i)
    if (!is_computable(data.points[i]))
      throw vtu_refused("point " + std::to_string(i) + " is too large or not finite");
}

void take_field(const XmlElement& array, const VtuArrays& arrays, Dataset& data) {
  Column column = arrays.column(array, arrays.count(array, "NumberOfTuples"));
  const auto* whole = std::get_if<std::vector<std::int32_t>>(&column.values);
  const auto* real = std::get_if<std::vector<double>>(&column.values);
  const std::size_t count = whole ? whole->size() : real->size();
  if (column.name == "TimeValue" && count == 1)
    data.time = whole ? whole->front() : real->front();
  else if (column.name == "CYCLE" && whole && count == 1)
    data.cycle = whole->front();
  else if (column.name == "sinew_meta" && array.attribute("type") == "UInt8")
    data.meta.assign(whole->begin(), whole->end());
  else {
    column.components = static_cast<int>(count);
    data.field_columns.push_back(std::move(column));
  }
}

bool is_wanted(const XmlElement& array, const std::optional<Names>& names) {
  return !names || std::find(names->begin(), names->end(), array.attribute("Name")) != names->end();
}

/// All point arrays where `names` is nullptr.
Dataset dataset_of(const VtuPiece& piece, const std::optional<Names>& names) {
  const XmlElement& counts = piece.elements.front();
  const auto points = piece.arrays().count(counts, "NumberOfPoints");
  const auto cells = piece.arrays().count(counts, "NumberOfCells");
  Dataset data;
  read_points(piece, points, data);
  read_cells(piece, cells, data);
  for (const XmlElement* array : piece.group("Piece/PointData"))
    if (is_wanted(*array, names))
      data.point_columns.push_back(piece.arrays().column(*array, points));
  for (const XmlElement* array : piece.group("Piece/CellData"))
    data.cell_columns.push_back(piece.arrays().column(*array, cells));
  return data;
}

Error unlike_pieces() { return vtu_refused("its pieces do not have the same arrays"); }

void append(const Column& part, Column& whole) {
  if (part.name != whole.name || part.components != whole.components) throw unlike_pieces();
  const auto add = [](auto& values, const auto& more) {
    values.insert(values.end(), more.begin(), more.end());
  };
  std::visit(
      [&](auto& values) {
        const auto* more = std::get_if<std::remove_reference_t<decltype(values)>>(&part.values);
        if (more == nullptr) throw unlike_pieces();
        add(values, *more);
      },
      whole.values);
}

/// Behind the pieces before.
void append(const Dataset& part, Dataset& whole) {
  if (part.kind != CellKind::vertex || whole.kind != CellKind::vertex ||
      !part.cell_columns.empty() || !whole.cell_columns.empty())
    throw vtu_refused("it has several pieces, and more than vertices");
  const auto before = static_cast<std::int32_t>(whole.points.size());
  for (const std::int32_t point : part.connectivity) whole.connectivity.push_back(before + point);
  whole.points.insert(whole.points.end(), part.points.begin(), part.points.end());
  if (part.point_columns.size() != whole.point_columns.size()) throw unlike_pieces();
  for (std::size_t k = 0; k < part.point_columns.size(); ++k)
    append(part.point_columns[k], whole.point_columns[k]);
}

Dataset dataset_of(const VtuFile& file, const std::optional<Names>& names) {
  const auto pieces = file.pieces();
  if (pieces.empty()) throw vtu_refused("it has no piece");
  Dataset data = dataset_of(VtuPiece{file, pieces.front()}, names);
  for (std::size_t k = 1; k < pieces.size(); ++k)
    append(dataset_of(VtuPiece{file, pieces[k]}, names), data);
  for (const XmlElement* array : file.arrays_in(file.elements, "FieldData"))
    take_field(*array, file.arrays, data);
  return data;
}

Dataset read_named(const std::filesystem::path& path, const std::optional<Names>& names) {
  try {
    return dataset_of(VtuFile(read_begun(path, text_only, check_start_of_xml)), names);
  } catch (const Error& error) {
    throw error.with_context({path.string()});
  } catch (const std::bad_alloc&) {
    throw bad_input({path.string()}, "needs more memory than there is", "read it elsewhere");
  }
}

}  // namespace

Dataset read_vtu(const std::filesystem::path& path) { return read_named(path, std::nullopt); }

Dataset read_vtu(const std::filesystem::path& path,
                 std::initializer_list<const char*> point_arrays) {
  return read_named(path, point_arrays);
}

}  // namespace sinew
