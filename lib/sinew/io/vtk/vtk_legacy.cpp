// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/vtk/detail/grids.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr std::string_view legacy_begin = "# vtk DataFile Version ";

Error damaged(const std::string& what) { return bad_input(what, "write the file again"); }

/// Numbers of a binary file, the first byte the highest.
template <class Number>
void convert(std::string_view bytes, std::vector<double>& to) {
  for (double& number : to) {
    std::array<char, sizeof(Number)> own;
    std::memcpy(own.data(), bytes.data(), own.size());
    bytes.remove_prefix(own.size());
    std::reverse(own.begin(), own.end());
    number = static_cast<double>(std::bit_cast<Number>(own));
  }
}

/// A type of numbers: VTK's name, bytes, and what reads them.
struct NumberType {
  std::string_view name;
  std::size_t size;
  void (*convert)(std::string_view bytes, std::vector<double>& to);
};

template <class Number>
constexpr NumberType number_type(std::string_view name) {
  return {name, sizeof(Number), convert<Number>};
}

const NumberType& type_named(std::string_view name) {
  static constexpr std::array types = {
      number_type<signed char>("char"),
      number_type<unsigned char>("unsigned_char"),
      number_type<std::int16_t>("short"),
      number_type<std::uint16_t>("unsigned_short"),
      number_type<std::int32_t>("int"),
      number_type<std::uint32_t>("unsigned_int"),
      number_type<std::int64_t>("long"),
      number_type<std::uint64_t>("unsigned_long"),
      number_type<std::int64_t>("vtktypeint64"),
      number_type<std::uint64_t>("vtktypeuint64"),
      number_type<std::int32_t>("vtkidtype"),  // VTK writes them as int
      number_type<float>("float"),
      number_type<double>("double")};
  const auto* found = std::find_if(
      types.begin(), types.end(), [&](const NumberType& type) { return type.name == lower(name); });
  if (found == types.end()) throw damaged("it has numbers of the type " + shown(name));
  return *found;
}

/// The parts of the file one after the other.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  std::size_t left() const { return rest_.size(); }  ///< bytes

  /// The rest of the line, which ends it.
  std::string_view line() {
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  /// The next word, "" at the end of the file.
  std::string_view word() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\n"));
    rest_.remove_prefix(word.size());
    return word;
  }

  double number() {
    const std::string_view text = word();
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number))
      throw damaged(shown(text) + " is in the place of a number");
    return number;
  }

  /// Every value takes a byte or more.
  std::uint64_t count() {
    const double count = number();
    if (!(count >= 0) || count != std::floor(count) || count > static_cast<double>(rest_.size()))
      throw damaged("it gives a number of " + number_text(count) + ", which its size cannot hold");
    return static_cast<std::uint64_t>(count);
  }

  /// `rows` times `columns` of them, after the line in which the last word stands.
  std::vector<double> numbers(std::string_view type_name, std::uint64_t rows,
                              std::uint64_t columns = 1) {
    const NumberType& type = type_named(type_name);
    const std::size_t least = binary ? type.size : 2;  // in text a digit and a blank
    if (columns > 0 && rows > (rest_.size() + 1) / columns / least)
      throw damaged("it is cut short: " + std::to_string(rows) + " times " +
                    std::to_string(columns) + " numbers are missing");
    std::vector<double> values(rows * columns);
    if (!binary) {
      for (double& value : values) value = number();
      return values;
    }
    line();
    if (rest_.size() < values.size() * type.size) throw damaged("it is cut short");
    type.convert(rest_, values);
    rest_.remove_prefix(values.size() * type.size);
    return values;
  }

  void skip(std::uint64_t bytes) {
    if (bytes > rest_.size()) throw damaged("it is cut short");
    rest_.remove_prefix(bytes);
  }

  /// One text of an array: a line, or its length (in 1, 2, 4 or 8 bytes, as the highest two bits
  /// say) and then its bytes.
  void skip_text() {
    if (!binary) return void(line());
    if (rest_.empty()) throw damaged("it is cut short");
    const std::size_t size = std::size_t{8} >> (static_cast<unsigned char>(rest_[0]) >> 6);
    if (size > rest_.size()) throw damaged("it is cut short");
    std::uint64_t length = static_cast<unsigned char>(rest_[0]) & 63;
    for (std::size_t i = 1; i < size; ++i)
      length = length << 8 | static_cast<unsigned char>(rest_[i]);
    skip(size);
    skip(length);
  }

  /// Up to the next empty line.
  void skip_metadata() {
    line();
    while (!at_end() && !line().empty()) {
    }
  }

  bool at_end() const { return rest_.find_first_not_of(" \t\r\n") == rest_.npos; }

  bool binary = false;

 private:
  std::string_view rest_;
};

bool is_whole(double number) { return std::abs(number) < 1e15 && number == std::floor(number); }

std::vector<std::int64_t> as_integers(const std::vector<double>& numbers) {
  std::vector<std::int64_t> integers;
  integers.reserve(numbers.size());
  for (const double number : numbers) {
    if (!is_whole(number))
      throw damaged(number_text(number) + " is in the place of a whole number");
    integers.push_back(static_cast<std::int64_t>(number));
  }
  return integers;
}

/// What is read of a file, on the way.
struct Content : LegacyContent {
  std::vector<std::int64_t> types;
  std::uint64_t others = 0;  ///< vertices and lines, which precede the cells in arrays of cells
  bool at_points = false;    ///< whether the image's values are at its points
};

/// An array at points or cells, or of a field.
struct Array {
  std::string_view name;
  std::uint64_t columns = 1;
  std::vector<double> values = {};
  std::size_t bytes = 0;
};

Array read_array(Reader& in, std::string_view name, std::string_view type, std::uint64_t rows,
                 std::uint64_t columns) {
  Array array{name, columns};
  const std::size_t before = in.left();
  if (type == "string") {
    in.line();
    if (columns > 0 && rows > in.left() / columns) throw damaged("it is cut short");
    for (std::uint64_t i = 0; i < rows * columns; ++i) in.skip_text();
  } else if (type == "bit" && in.binary) {
    in.line();
    in.skip((rows * columns + 7) / 8);
  } else {
    array.values = in.numbers(type == "bit" ? "char" : type, rows, columns);
  }
  array.bytes = before - in.left();
  return array;
}

void add_cell(const std::int64_t* begin, const std::int64_t* end, int type, VtkCells& cells) {
  cells.points.insert(cells.points.end(), begin, end);
  cells.ends.push_back(static_cast<std::int64_t>(cells.points.size()));
  if (type >= 0) cells.types.push_back(type);
}

/// Each cell as its number of points and these.
void read_counted_cells(Reader& in, std::uint64_t count, std::uint64_t size, int type,
                        VtkCells& cells) {
  const auto numbers = as_integers(in.numbers("int", size));
  std::size_t at = 0;
  for (std::uint64_t cell = 0; cell < count; ++cell) {
    const std::int64_t points = at < numbers.size() ? numbers[at] : -1;
    if (points < 0 || points >= static_cast<std::int64_t>(numbers.size() - at))
      throw damaged("cell " + std::to_string(cell) + " ends outside of the list of points");
    const std::int64_t* begin = numbers.data() + at + 1;
    add_cell(begin, begin + points, type, cells);
    at += static_cast<std::size_t>(points) + 1;
  }
}

/// Version 5: where each begins, and the end of the last; then all their points.
void read_offset_cells(Reader& in, std::uint64_t count, std::uint64_t size, int type,
                       VtkCells& cells) {
  const auto array = [&](const char* name, std::uint64_t length) {
    if (in.word() != name) throw damaged("its cells have no " + std::string(name));
    const std::string_view of = in.word();
    return as_integers(in.numbers(of, length));
  };
  const auto offsets = array("OFFSETS", count);
  const auto points = array("CONNECTIVITY", size);
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
    if (offsets[i] < 0 || offsets[i + 1] < offsets[i] ||
        offsets[i + 1] > static_cast<std::int64_t>(points.size()))
      throw damaged("cell " + std::to_string(i) + " ends outside of the list of points");
    add_cell(points.data() + offsets[i], points.data() + offsets[i + 1], type, cells);
  }
}

/// `type`: of all of them, or -1 where CELL_TYPES says.
void read_cells(Reader& in, double version, int type, VtkCells& cells) {
  const std::uint64_t count = in.count(), size = in.count();
  if (version >= 5)
    read_offset_cells(in, count, size, type, cells);
  else
    read_counted_cells(in, count, size, type, cells);
}

void read_points(Reader& in, Points& points) {
  const std::uint64_t count = in.count();
  const auto numbers = in.numbers(in.word(), count, 3);
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(&numbers[3 * i]);
    if (!points.back().allFinite()) throw damaged("point " + std::to_string(i) + " is not finite");
  }
}

Array read_scalars(Reader& in, std::uint64_t rows) {
  const std::string_view name = in.word(), type = in.word();
  Reader after = in;
  const std::uint64_t columns = after.word() == "LOOKUP_TABLE" ? 1 : in.count();
  if (in.word() != "LOOKUP_TABLE") throw damaged("its scalars have no LOOKUP_TABLE");
  in.word();
  return read_array(in, name, type, rows, columns);
}

/// Numbers that each row of an array of that kind has; 0: another keyword.
std::uint64_t columns_of(std::string_view keyword) {
  if (keyword == "GLOBAL_IDS" || keyword == "PEDIGREE_IDS" || keyword == "EDGE_FLAGS") return 1;
  if (keyword == "VECTORS" || keyword == "NORMALS") return 3;
  if (keyword == "TENSORS6") return 6;
  return keyword == "TENSORS" ? 9 : 0;
}

/// Calls take(array) for each array of that keyword. False: it does not begin arrays.
template <class Take>
bool read_arrays(Reader& in, std::string_view keyword, std::uint64_t rows, const Take& take) {
  const std::string_view color = in.binary ? "unsigned_char" : "float";
  if (keyword == "SCALARS") {
    take(read_scalars(in, rows));
  } else if (const std::uint64_t columns = columns_of(keyword); columns > 0) {
    const std::string_view name = in.word();
    take(read_array(in, name, in.word(), rows, columns));
  } else if (keyword == "TEXTURE_COORDINATES") {
    const std::string_view name = in.word();
    const std::uint64_t parts = in.count();
    take(read_array(in, name, in.word(), rows, parts));
  } else if (keyword == "COLOR_SCALARS" || keyword == "LOOKUP_TABLE") {
    const std::string_view name = in.word();
    const std::uint64_t size = in.count();
    const bool table = keyword == "LOOKUP_TABLE";
    const Array colors = read_array(in, name, color, table ? size : rows, table ? 4 : size);
    if (!table) take(colors);
  } else if (keyword == "FIELD") {
    in.word();  // its name
    const std::uint64_t arrays = in.count();
    for (std::uint64_t i = 0; i < arrays; ++i) {
      std::string_view name = in.word();
      if (name == "METADATA") in.skip_metadata(), name = in.word();
      const std::uint64_t parts = in.count(), count = in.count();
      take(read_array(in, name, in.word(), count, parts));
    }
  } else {
    return false;
  }
  return true;
}

Vec3 read_vector(Reader& in) {
  Vec3 vector;
  for (double& number : vector) number = in.number();
  return vector;
}

void read_dimensions(Reader& in, LevelSet& image) {
  for (int& size : image.size) {
    const std::uint64_t count = in.count();
    if (count > 1'000'000'000) throw damaged("its dimensions are too large");
    size = static_cast<int>(count);
  }
}

/// Where the samples of an image are. False: a keyword that is not known.
bool read_of_image(Reader& in, std::string_view keyword, LevelSet& image) {
  if (keyword == "DIMENSIONS")
    read_dimensions(in, image);
  else if (keyword == "SPACING" || keyword == "ASPECT_RATIO")
    image.axes = read_vector(in).asDiagonal();
  else if (keyword == "ORIGIN")
    image.origin = read_vector(in);
  else
    return false;
  return true;
}

/// What defines the cells. False: a keyword that is not known.
bool read_of_grid(Reader& in, std::string_view keyword, double version, Content& content) {
  VtkCells unused;
  if (keyword == "POINTS")
    read_points(in, content.grid.points);
  else if (keyword == "POLYGONS")
    read_cells(in, version, vtk_polygon, content.grid.cells);
  else if (keyword == "TRIANGLE_STRIPS")
    read_cells(in, version, vtk_strip, content.grid.cells);
  else if (keyword == "VERTICES" || keyword == "LINES")
    read_cells(in, version, 0, unused), content.others += unused.ends.size();
  else if (keyword == "CELLS")
    read_cells(in, version, -1, content.grid.cells);
  else if (keyword == "CELL_TYPES")
    content.types = as_integers(in.numbers("int", in.count()));
  else
    return false;
  return true;
}

bool is_image(std::string_view dataset) {
  if (dataset == "STRUCTURED_POINTS") return true;
  if (dataset == "POLYDATA" || dataset == "UNSTRUCTURED_GRID") return false;
  throw bad_input("it holds " + shown(dataset) + ", which is not read",
                  "save its surface as .vtp: in ParaView, Extract Surface");
}

/// Takes the first single values of an image, those at its points before those at its cells.
void take_of_image(const Array& array, bool cells, Content& content) {
  if (array.columns != 1 || array.values.empty() || content.at_points) return;
  LevelSet& image = *content.image;
  if (cells && !image.values.empty()) return;
  image.values = array.values;
  image.bytes = array.bytes;
  content.at_points = !cells;
}

/// Takes flags and numbers of materials.
void take_of_cells(const Array& array, Content& content) {
  VtkCells& cells = content.grid.cells;
  const bool old = array.name == old_ghost_array;
  if (old || array.name == ghost_array) {
    cells.ghosts.clear();
    for (std::size_t i = content.others; i < array.values.size(); ++i)
      cells.ghosts.push_back(
          static_cast<std::uint8_t>(old ? array.values[i] > 0 : array.values[i]));
  } else if (array.columns == 1 && names_materials(array.name) && cells.materials.empty() &&
             std::all_of(array.values.begin(), array.values.end(), is_whole)) {
    for (std::size_t i = content.others; i < array.values.size(); ++i)
      cells.materials.push_back(static_cast<std::int64_t>(array.values[i]));
  }
}

/// The arrays of points and cells. Those of a grid concern it only where they have flags: it needs
/// no others, and keeps what was read where one of them is damaged or of an unknown kind.
void read_data(Reader& in, std::string_view keyword, Content& content) {
  bool cells = keyword == "CELL_DATA";
  std::uint64_t rows = in.count();
  while (!in.at_end() && !content.at_points) {
    keyword = in.word();
    if (keyword == "METADATA") {
      in.skip_metadata();
    } else if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
      cells = keyword == "CELL_DATA";
      rows = in.count();
    } else if (!read_arrays(in, keyword, rows, [&](const Array& array) {
                 if (content.image) take_of_image(array, cells, content);
                 if (!content.image && cells) take_of_cells(array, content);
               })) {
      throw damaged("it has an unknown word " + shown(keyword));
    }
  }
}

void read_data_of_grid(Reader& in, std::string_view keyword, Content& content) {
  try {
    read_data(in, keyword, content);
  } catch (const Error&) {
  }
}

Content content_of(Reader& in, double version, bool image) {
  Content content;
  if (image) content.image.emplace();
  while (!in.at_end()) {
    const std::string_view keyword = in.word();
    if (keyword == "METADATA") {
      in.skip_metadata();
    } else if (keyword == "FIELD") {
      read_arrays(in, keyword, 0, [](const Array&) {});
    } else if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
      image ? read_data(in, keyword, content) : read_data_of_grid(in, keyword, content);
      break;
    } else if (!(image ? read_of_image(in, keyword, *content.image)
                       : read_of_grid(in, keyword, version, content))) {
      throw damaged("it has an unknown word " + shown(keyword));
    }
  }
  return content;
}

LegacyContent checked(Content content) {
  if (!content.image) {
    for (const std::int64_t type : content.types)
      content.grid.cells.types.push_back(std::in_range<int>(type) ? static_cast<int>(type) : -1);
    return content;
  }
  LevelSet& image = *content.image;
  if (image.values.empty())
    throw bad_input("the image has no scalars at its points or cells",
                    "store the level set as the first scalars of its points");
  if (!content.at_points) move_to_cells(image);
  const double samples = double(image.size[0]) * image.size[1] * image.size[2];
  if (samples != static_cast<double>(image.values.size()))
    throw damaged("the image has " + std::to_string(image.values.size()) + " values of " +
                  number_text(samples));
  return content;
}

}  // namespace

void check_start_of_legacy(std::string_view text) {
  if (!text.starts_with(legacy_begin)) throw damaged("it is no legacy VTK file");
}

LegacyContent legacy_content(std::string_view text) {
  check_start_of_legacy(text);
  Reader in(text);
  const double version = Reader(in.line().substr(legacy_begin.size())).number();
  in.line();  // the title
  const std::string_view coding = in.word();
  if (coding != "ASCII" && coding != "BINARY")
    throw damaged("it is neither ASCII nor BINARY, but " + shown(coding));
  in.binary = coding == "BINARY";
  std::string_view keyword = in.word();
  if (keyword == "DATASET") return checked(content_of(in, version, is_image(in.word())));
  throw damaged("it has " + shown(keyword) + " in the place of DATASET");
}

}  // namespace sinew
