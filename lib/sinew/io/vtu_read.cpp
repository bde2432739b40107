// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <new>
#include <numeric>
#include <optional>

#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/io/vtk/vtk_xml.h>
#include <sinew/io/vtu.h>
#include <sinew/io/vtu_array.h>

namespace sinew {
namespace {

constexpr std::uint64_t largest_file = std::uint64_t{1} << 40;  // bytes

using Names = std::vector<std::string_view>;

/// The elements of the file, whose grid is to be one piece.
struct VtuFile : VtkXmlFile {
  explicit VtuFile(std::string_view text) : VtkXmlFile(vtk_xml_file(text)) {
    if (type != "UnstructuredGrid")
      throw vtu_refused("it holds " + shown(type) + ", not an UnstructuredGrid");
  }

  std::vector<const XmlElement*> group(const std::string& name) const {
    return arrays_in(elements, name);
  }
};

const XmlElement& piece_of(const VtuFile& file) {
  const auto pieces = file.pieces();
  if (pieces.size() != 1)
    throw vtu_refused("it has " + std::to_string(pieces.size()) + " pieces, not one");
  return pieces.front().front();
}

/// The integers of one of the arrays that make up the cells.
std::vector<std::int32_t> of_cells(const VtuFile& file, const char* name, std::uint64_t count) {
  for (const XmlElement* array : file.group("Piece/Cells")) {
    if (array->attribute("Name") != name) continue;
    Column column = file.arrays.column(*array, count);
    if (auto* integers = std::get_if<std::vector<std::int32_t>>(&column.values))
      return std::move(*integers);
    throw vtu_refused("array " + quoted(name) + " does not hold integers of 32 bits");
  }
  throw vtu_refused("its cells have no " + std::string(name));
}

CellKind kind_of(const std::vector<std::int32_t>& types) {
  for (const std::int32_t type : types)
    if (type != types.front()) throw vtu_refused("its cells are not all of one kind");
  for (const CellKind kind : {CellKind::vertex, CellKind::line, CellKind::triangle})
    if (types.front() == vtk_type(kind)) return kind;
  throw vtu_refused("it holds cells of VTK's type " + std::to_string(types.front()) +
                    ", not vertices, lines or triangles");
}

void read_cells(const VtuFile& file, std::uint64_t cells, Dataset& data) {
  if (cells == 0) return;
  data.kind = kind_of(of_cells(file, "types", cells));
  const auto size = static_cast<std::int64_t>(data.kind);
  const auto ends = of_cells(file, "offsets", cells);
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (ends[i] != static_cast<std::int64_t>(i + 1) * size)
      throw vtu_refused("a cell does not have " + std::to_string(size) + " point(s)");
  data.connectivity = of_cells(file, "connectivity", cells * static_cast<std::uint64_t>(size));
  for (const std::int32_t id : data.connectivity)
    if (id < 0 || static_cast<std::size_t>(id) >= data.points.size())
      throw vtu_refused("a cell names a point that is not there");
}

void read_points(const VtuFile& file, std::uint64_t points, Dataset& data) {
  const auto arrays = file.group("Piece/Points");
  if (points == 0) return;
  if (arrays.size() != 1) throw vtu_refused("its points are not one array");
  data.points = file.arrays.points(*arrays.front(), points);
  for (std::size_t i = 0; i < data.points.size(); ++i)
    if (!data.points[i].allFinite())
      throw vtu_refused("point " + std::to_string(i) + " is not finite");
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
Dataset dataset_of(const VtuFile& file, const std::optional<Names>& names) {
  const XmlElement& piece = piece_of(file);
  const auto points = file.arrays.count(piece, "NumberOfPoints");
  const auto cells = file.arrays.count(piece, "NumberOfCells");
  Dataset data;
  read_points(file, points, data);
  read_cells(file, cells, data);
  for (const XmlElement* array : file.group("Piece/PointData"))
    if (is_wanted(*array, names)) data.point_columns.push_back(file.arrays.column(*array, points));
  for (const XmlElement* array : file.group("Piece/CellData"))
    data.cell_columns.push_back(file.arrays.column(*array, cells));
  for (const XmlElement* array : file.group("FieldData")) take_field(*array, file.arrays, data);
  return data;
}

// Files in several pieces.

/// The same columns of a part of the points, behind those of the parts before.
void append(const Column& part, Column& whole) {
  if (part.name != whole.name || part.components != whole.components ||
      part.values.index() != whole.values.index())
    throw vtu_refused("its pieces do not have the same arrays");
  std::visit(
      [&](auto& values) {
        const auto& more = std::get<std::remove_reference_t<decltype(values)>>(part.values);
        values.insert(values.end(), more.begin(), more.end());
      },
      whole.values);
}

void append(const Dataset& part, Dataset& whole) {
  whole.time = part.time;
  whole.cycle = part.cycle;
  if (!part.meta.empty()) whole.meta = part.meta;
  for (const Column& column : part.field_columns)
    if (!find(whole.field_columns, column.name)) whole.field_columns.push_back(column);
  if (part.points.empty()) return;
  if (part.kind != CellKind::vertex) throw vtu_refused("its pieces do not hold particles");
  if (whole.points.empty()) {
    whole.point_columns = part.point_columns;
  } else {
    if (part.point_columns.size() != whole.point_columns.size())
      throw vtu_refused("its pieces do not have the same arrays");
    for (std::size_t k = 0; k < part.point_columns.size(); ++k)
      append(part.point_columns[k], whole.point_columns[k]);
  }
  whole.points.insert(whole.points.end(), part.points.begin(), part.points.end());
}

template <class Rows>
void reorder(const std::vector<std::uint32_t>& order, std::size_t width, Rows& rows) {
  Rows ordered;
  ordered.reserve(rows.size());
  for (const std::uint32_t from : order)
    for (std::size_t k = 0; k < width; ++k) ordered.push_back(rows[width * from + k]);
  rows = std::move(ordered);
}

void sort_by_id(Dataset& data) {
  if (data.points.empty()) return;
  const std::vector<std::int32_t>& ids = integers(data.point_columns, "id");
  std::vector<std::uint32_t> order(ids.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return ids[a] < ids[b]; });
  for (std::size_t k = 1; k < order.size(); ++k)
    if (ids[order[k]] == ids[order[k - 1]])
      throw vtu_refused("particle " + std::to_string(ids[order[k]]) + " is in it twice");
  reorder(order, 1, data.points);
  for (Column& column : data.point_columns) {
    const auto width = static_cast<std::size_t>(column.components);
    std::visit([&](auto& values) { reorder(order, width, values); }, column.values);
  }
}

Dataset read_named(const std::filesystem::path& path, const std::optional<Names>& names);

Dataset read_pieces(std::string_view text, const std::optional<Names>& names,
                    const std::filesystem::path& path) {
  const VtkXmlFile file = vtk_xml_file(text);
  if (file.type != "PUnstructuredGrid")
    throw vtu_refused("it holds " + shown(file.type) + ", not a PUnstructuredGrid");
  Dataset data;
  std::optional<Names> with_id = names;
  if (with_id) with_id->push_back("id");
  for (const auto& piece : file.pieces()) {
    const std::filesystem::path name = piece.front().attribute("Source");
    if (name.empty() || name != name.filename() || name.extension() != ".vtu")
      throw vtu_refused("a piece of it is " + shown(name.string()) + ", not a .vtu file beside it");
    append(read_named(path.parent_path() / name, with_id), data);
  }
  sort_by_id(data);
  data.connectivity = vertex_cells(data.points.size());
  if (names)
    std::erase_if(data.point_columns, [&](const Column& column) {
      return std::find(names->begin(), names->end(), column.name) == names->end();
    });
  return data;
}

Dataset read_text(std::string_view text, const std::optional<Names>& names,
                  const std::filesystem::path& path) {
  try {
    if (path.extension() == ".pvtu") return read_pieces(text, names, path);
    return dataset_of(VtuFile(text), names);
  } catch (const Error& error) {
    throw error.with_context({path.string()});
  }
}

Dataset read_named(const std::filesystem::path& path, const std::optional<Names>& names) {
  try {
    return read_text(read_file(path, largest_file), names, path);
  } catch (const std::bad_alloc&) {
    throw bad_input({path.string()}, "needs more memory than there is", "read it elsewhere");
  }
}

}  // namespace

Dataset read_vtu(const std::filesystem::path& path) { return read_named(path, std::nullopt); }

Dataset read_vtu(const std::filesystem::path& path,
                 std::initializer_list<const char*> point_arrays) {
  return read_named(path, Names(point_arrays.begin(), point_arrays.end()));
}

}  // namespace sinew
