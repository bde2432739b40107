// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <new>
#include <optional>

#include <sinew/core/file.h>
#include <sinew/io/vtu.h>
#include <sinew/io/vtu_array.h>
#include <sinew/io/xml.h>

namespace sinew {
namespace {

constexpr std::uint64_t largest_file = std::uint64_t{1} << 40;  // bytes
constexpr std::string_view in_grid = "VTKFile/UnstructuredGrid/";
constexpr std::string_view appended_path = "VTKFile/AppendedData";

using Names = std::initializer_list<const char*>;

/// The attributes of the file, and its arrays still encoded.
struct VtuFile {
  std::vector<XmlElement> elements;
  VtuArrays arrays;

  /// Those in a group of the grid, such as "Piece/PointData".
  std::vector<const XmlElement*> group(const std::string& name) const {
    const std::string numbers = std::string(in_grid) + name + "/DataArray";
    const std::string words = std::string(in_grid) + name + "/Array";
    std::vector<const XmlElement*> found;
    for (const XmlElement& element : elements)
      if (element.path == numbers || element.path == words) found.push_back(&element);
    return found;
  }
};

void check_start_and_end(std::string_view text) {
  if (!text.starts_with('<') || text.substr(0, 4096).find("<VTKFile") == text.npos)
    throw vtu_refused("it is not a VTK XML file");
  // An interrupted writer leaves a file without its last tag.
  if (!text.substr(0, text.find_last_not_of(" \t\r\n") + 1).ends_with("</VTKFile>"))
    throw vtu_refused("it is cut short");
}

void check_root(const XmlElement& root) {
  if (root.path != "VTKFile") throw vtu_refused("it is not a VTK XML file");
  if (const auto type = root.attribute("type"); type != "UnstructuredGrid")
    throw vtu_refused("it holds " + quoted(type) + ", not an UnstructuredGrid");
  if (root.attribute("byte_order") == "BigEndian")
    throw vtu_refused("it is of a big-endian machine");
}

Coding coding_of(const XmlElement& root) {
  const auto compressor = root.attribute("compressor");
  const auto header = root.attribute("header_type");
  Coding coding;
  coding.word = header == "UInt64" ? 8 : 4;
  if (!header.empty() && header != "UInt64" && header != "UInt32")
    throw vtu_refused("its header_type is " + quoted(header));
  if (compressor.empty())
    coding.encoding = Encoding::none;
  else if (compressor == "vtkZLibDataCompressor")
    coding.encoding = Encoding::zlib;
  else if (compressor == "vtkLZ4DataCompressor")
    coding.encoding = Encoding::lz4;
  else
    throw vtu_refused("it is compressed by " + quoted(compressor) + ", not by ZLib or LZ4");
  return coding;
}

VtuFile file_of(std::string_view text) {
  check_start_and_end(text);
  VtuFile file{xml_elements(text, appended_path), {}};
  check_root(file.elements.front());
  VtuArrays& arrays = file.arrays;
  arrays.within = arrays.behind = coding_of(file.elements.front());
  arrays.most = text.size() * most_expansion;
  const XmlElement& last = file.elements.back();
  if (last.path != appended_path) return file;
  arrays.behind.base64 = last.attribute("encoding") != "raw";
  const auto mark = last.text.find('_');
  if (mark != last.text.npos) arrays.appended = last.text.substr(mark + 1);
  return file;
}

const XmlElement& piece_of(const VtuFile& file) {
  const std::string path = std::string(in_grid) + "Piece";
  const auto is_piece = [&](const XmlElement& element) { return element.path == path; };
  const auto pieces = std::count_if(file.elements.begin(), file.elements.end(), is_piece);
  if (pieces != 1) throw vtu_refused("it has " + std::to_string(pieces) + " pieces, not one");
  return *std::find_if(file.elements.begin(), file.elements.end(), is_piece);
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

Dataset read_text(std::string_view text, const std::optional<Names>& names,
                  const std::filesystem::path& path) {
  try {
    return dataset_of(file_of(text), names);
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
  return read_named(path, point_arrays);
}

}  // namespace sinew
