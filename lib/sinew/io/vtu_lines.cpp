// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/vtu_lines.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <fstream>
#include <string>

#include <sinew/core/parallel.h>
#include <sinew/io/decode.h>
#include <sinew/io/vtu_blocks.h>
#include <sinew/io/vtu_tags.h>

namespace sinew {
namespace {

constexpr std::size_t values_per_piece = 1 << 15;
constexpr std::uint64_t most_components = 1000;

/// Leads to nothing being returned: who reads all of XML will tell what is wrong.
struct NotOurs {};

void require(bool ours) {
  if (!ours) throw NotOurs();
}

class Lines {
 public:
  explicit Lines(std::string_view text) : left_(text) {}

  std::string_view next() {
    const auto end = left_.find('\n');
    require(end != left_.npos);
    const auto line = left_.substr(0, end);
    left_.remove_prefix(end + 1);
    return line;
  }

 private:
  std::string_view left_;
};

std::string_view attribute(std::string_view tag, const std::string& name) {
  const auto at = tag.find(' ' + name + "=\"");
  if (at == tag.npos) return {};
  tag.remove_prefix(at + name.size() + 3);
  const auto value = tag.substr(0, tag.find('"'));
  require(value.find('&') == value.npos);
  return value;
}

/// Whether a line is that tag and nothing else.
bool is_tag(std::string_view line, std::string_view name) {
  const bool named = line.starts_with('<') && line.substr(1, name.size()) == name &&
                     line.find_first_of(" >") == name.size() + 1;
  return named && line.find('>') == line.size() - 1 && line.find('<', 1) == line.npos;
}

/// No count is above `most`.
std::uint64_t count_of(std::string_view tag, const std::string& name, std::uint64_t most) {
  const auto text = attribute(tag, name);
  std::uint64_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  require(error == std::errc() && end == text.data() + text.size() && count <= most);
  return count;
}

/// An array, encoded.
struct Element {
  std::string_view tag, text;
  std::uint64_t components = 1;

  std::string name() const { return std::string(attribute(tag, "Name")); }
};

Element next_element(std::string_view tag, Lines& lines) {
  require(is_tag(tag, "DataArray") && attribute(tag, "format") == "binary");
  Element element{tag, lines.next()};
  if (!attribute(tag, "NumberOfComponents").empty())
    element.components = count_of(tag, "NumberOfComponents", most_components);
  auto line = lines.next();
  if (line.starts_with("<InformationKey ")) {
    lines.next();
    require(lines.next() == "</InformationKey>");
    line = lines.next();
  }
  require(line == "</DataArray>");
  return element;
}

std::vector<Element> next_group(const std::string& name, Lines& lines) {
  require(is_tag(lines.next(), name));
  const std::string end = "</" + name + '>';
  std::vector<Element> elements;
  for (auto line = lines.next(); line != end; line = lines.next())
    elements.push_back(next_element(line, lines));
  return elements;
}

/// The file as it lies there.
struct Parts {
  Encoding encoding = Encoding::none;
  std::uint64_t points = 0, cells = 0;
  std::vector<Element> field, of_points, of_cells, place, shape;
};

Encoding encoding_of(std::string_view start) {
  for (const Encoding encoding : {Encoding::zlib, Encoding::lz4, Encoding::none})
    if (start.starts_with(vtu_opening(encoding))) return encoding;
  throw NotOurs();
}

Parts parts_of(std::string_view text) {
  Parts parts;
  parts.encoding = encoding_of(text);
  const std::uint64_t most = text.size() * most_expansion;
  text.remove_prefix(vtu_opening(parts.encoding).size());
  Lines lines(text);
  parts.field = next_group("FieldData", lines);
  const auto piece = lines.next();
  require(is_tag(piece, "Piece"));
  parts.points = count_of(piece, "NumberOfPoints", most);
  parts.cells = count_of(piece, "NumberOfCells", most);
  parts.of_points = next_group("PointData", lines);
  parts.of_cells = next_group("CellData", lines);
  parts.place = next_group("Points", lines);
  parts.shape = next_group("Cells", lines);
  for (const char* line : {"</Piece>", "</UnstructuredGrid>", "</VTKFile>"})
    require(lines.next() == line);
  return parts;
}

template <class From, class To>
std::vector<To> values_as(const Element& element, Encoding encoding, std::uint64_t count) {
  const auto bytes = element_bytes(element.text, encoding, count * sizeof(From));
  require(bytes.has_value());
  std::vector<To> values(count);
  parallel_for(count, values_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      From value;
      std::memcpy(&value, bytes->data() + i * sizeof value, sizeof value);
      values[i] = static_cast<To>(value);
    }
  });
  return values;
}

Column column_of(const Element& element, Encoding encoding, std::uint64_t rows) {
  Column column{element.name(), static_cast<int>(element.components), {}};
  const auto type = attribute(element.tag, "type");
  const std::uint64_t count = rows * element.components;
  if (type == "Int32")
    column.values = values_as<std::int32_t, std::int32_t>(element, encoding, count);
  else if (type == "UInt8")
    column.values = values_as<unsigned char, std::int32_t>(element, encoding, count);
  else if (type == "Float32")
    column.values = values_as<float, double>(element, encoding, count);
  else if (type == "Float64")
    column.values = values_as<double, double>(element, encoding, count);
  else
    throw NotOurs();
  return column;
}

/// The values of the array of that name, of which there is just one in `elements`.
template <class Value>
std::vector<Value> values_of(const std::vector<Element>& elements, const char* name,
                             Encoding encoding, std::uint64_t rows) {
  const auto found = std::find_if(elements.begin(), elements.end(), [&](const Element& element) {
    return attribute(element.tag, "Name") == name;
  });
  require(found != elements.end());
  Column column = column_of(*found, encoding, rows);
  require(std::holds_alternative<std::vector<Value>>(column.values));
  return std::get<std::vector<Value>>(std::move(column.values));
}

Points points_of(const Parts& parts) {
  require(parts.place.size() == 1 && parts.place[0].components == 3);
  const auto flat = values_of<double>(parts.place, "Points", parts.encoding, parts.points);
  Points points(parts.points);
  parallel_for(points.size(), values_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points[i] = Vec3(&flat[3 * i]);
  });
  return points;
}

CellKind kind_of(const Parts& parts) {
  const auto types = values_of<std::int32_t>(parts.shape, "types", parts.encoding, parts.cells);
  if (types.empty()) return CellKind::vertex;
  require(std::all_of(types.begin(), types.end(), [&](int type) { return type == types[0]; }));
  for (const CellKind kind : {CellKind::vertex, CellKind::line, CellKind::triangle})
    if (types[0] == vtk_type(kind)) return kind;
  throw NotOurs();
}

std::vector<std::int32_t> connectivity_of(const Parts& parts, int size) {
  const auto ends = values_of<std::int32_t>(parts.shape, "offsets", parts.encoding, parts.cells);
  for (std::size_t i = 0; i < ends.size(); ++i)
    require(ends[i] == static_cast<std::int64_t>(i + 1) * size);
  auto ids =
      values_of<std::int32_t>(parts.shape, "connectivity", parts.encoding, parts.cells * size);
  for (const std::int32_t id : ids)
    require(id >= 0 && id < static_cast<std::int64_t>(parts.points));
  return ids;
}

void take_field(const Element& element, Encoding encoding, Dataset& data) {
  const std::uint64_t rows = count_of(element.tag, "NumberOfTuples", element.text.size());
  Column column = column_of(element, encoding, rows);
  const auto* whole = std::get_if<std::vector<std::int32_t>>(&column.values);
  const auto* real = std::get_if<std::vector<double>>(&column.values);
  if (column.name == "TimeValue" && real && real->size() == 1)
    data.time = real->front();
  else if (column.name == "CYCLE" && whole && whole->size() == 1)
    data.cycle = whole->front();
  else if (column.name == "sinew_meta" && whole && attribute(element.tag, "type") == "UInt8")
    data.meta.assign(whole->begin(), whole->end());
  else {
    column.components = static_cast<int>(whole ? whole->size() : real->size());
    data.field_columns.push_back(std::move(column));
  }
}

using Names = std::optional<std::initializer_list<const char*>>;

bool is_wanted(const Element& element, const Names& names) {
  return !names || std::any_of(names->begin(), names->end(), [&](const char* name) {
    return attribute(element.tag, "Name") == name;
  });
}

Dataset dataset_of(const Parts& parts, const Names& names) {
  Dataset data;
  data.points = points_of(parts);
  data.kind = kind_of(parts);
  data.connectivity = connectivity_of(parts, static_cast<int>(data.kind));
  for (const Element& element : parts.of_points)
    if (is_wanted(element, names))
      data.point_columns.push_back(column_of(element, parts.encoding, parts.points));
  for (const Element& element : parts.of_cells)
    data.cell_columns.push_back(column_of(element, parts.encoding, parts.cells));
  for (const Element& element : parts.field) take_field(element, parts.encoding, data);
  return data;
}

void read_on(std::ifstream& file, std::string& text, std::size_t size) {
  const std::size_t from = text.size();
  text.resize(size);
  require(!!file.read(&text[from], static_cast<std::streamsize>(size - from)));
}

/// The whole file where it begins as ours do.
std::string text_of(const std::filesystem::path& path) {
  std::error_code failed;
  require(std::filesystem::is_regular_file(path, failed));
  const std::size_t size = std::filesystem::file_size(path, failed);
  require(!failed);
  std::ifstream file(path, std::ios::binary);
  std::string text;
  read_on(file, text, std::min<std::size_t>(size, 512));
  encoding_of(text);
  read_on(file, text, size);
  return text;
}

}  // namespace

std::optional<Dataset> read_vtu_lines(const std::filesystem::path& path, const Names& names) {
  try {
    const std::string text = text_of(path);
    return dataset_of(parts_of(text), names);
  } catch (const NotOurs&) {
    return std::nullopt;
  }
}

}  // namespace sinew
