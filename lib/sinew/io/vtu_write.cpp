// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstring>
#include <future>
#include <type_traits>

#include <sinew/core/arrays.h>
#include <sinew/core/base64.h>
#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/parallel.h>
#include <sinew/core/text.h>
#include <sinew/io/detail/encode.h>
#include <sinew/io/detail/xml.h>
#include <sinew/io/vtu.h>

namespace sinew {
namespace {

/// Float32 has 24 bits: beyond this many radii its resolution is coarser than a thousandth of r.
constexpr double float32_reach = 1e4;
constexpr std::size_t points_per_piece = 8192;
constexpr std::size_t bytes_per_write = 1 << 20;

/// An array with the attributes of its element.
struct Element {
  std::string name;
  int components = 1;
  const WrittenArray* row = nullptr;
  FileArray values;
};

bool as_float64(const WrittenArray* row, const VtuFormat& format) {
  return format.double_precision || (row && row->numbers == ArrayNumbers::exact);
}

/// The values of a column in the file's number type.
struct Stored {
  bool float64 = false;

  FileArray operator()(const std::vector<std::int32_t>& whole) const { return int32_array(whole); }
  FileArray operator()(const Computed<std::int32_t>& whole) const { return int32_array(whole); }
  FileArray operator()(const std::vector<double>& real) const {
    return float64 ? float64_array(real.data(), real.size())
                   : float32_array(real.data(), real.size());
  }
  FileArray operator()(const Computed<double>& real) const {
    return float64 ? float64_array(real) : float32_array(real);
  }
};

template <class AnyColumn>
Element element_of(const AnyColumn& column, ArrayPlace place, const VtuFormat& format) {
  const WrittenArray* row = find_written(format.series, place, column.name);
  return {column.name, column.components, row,
          std::visit(Stored{as_float64(row, format)}, column.values)};
}

std::vector<Element> elements_of(const std::vector<Column>& columns, ArrayPlace place,
                                 const VtuFormat& format) {
  std::vector<Element> elements;
  elements.reserve(columns.size());
  for (const Column& column : columns) elements.push_back(element_of(column, place, format));
  return elements;
}

std::vector<Element> point_elements(const Dataset& data, const VtuFormat& format) {
  std::vector<Element> elements;
  for (const ComputedColumn& column : data.computed)
    elements.push_back(element_of(column, ArrayPlace::point, format));
  for (Element& element : elements_of(data.point_columns, ArrayPlace::point, format))
    elements.push_back(std::move(element));
  return elements;
}

std::vector<Element> field_elements(const Dataset& data, const VtuFormat& format) {
  const auto named = [&](const char* name, FileArray values) {
    return Element{name, 1, find_written(format.series, ArrayPlace::field, name),
                   std::move(values)};
  };
  std::vector<Element> elements{
      named("TimeValue", float64_array(&data.time, 1)),
      named("CYCLE", int32_array(1, [cycle = data.cycle](std::size_t) { return cycle; }))};
  for (Element& element : elements_of(data.field_columns, ArrayPlace::field, format))
    elements.push_back(std::move(element));
  if (!data.meta.empty()) elements.push_back(named("sinew_meta", bytes_array(data.meta)));
  return elements;
}

Element points_element(const Dataset& data, const VtuFormat& format) {
  const WrittenArray* row = find_written(format.series, ArrayPlace::point, "Points");
  const bool float64 =
      as_float64(row, format) || format.double_points || beyond_float32(data.points, format.radius);
  const double* first = data.points.empty() ? nullptr : data.points.front().data();
  const std::size_t count = 3 * data.points.size();
  return {"Points", 3, row, float64 ? float64_array(first, count) : float32_array(first, count)};
}

/// Cells of the dataset's kind, then its lines.
std::vector<Element> cell_elements(const Dataset& data) {
  const auto size = static_cast<std::size_t>(data.kind);
  const std::size_t corners = data.connectivity.size(), alike = corners / size;
  const auto corner = [&data, corners](std::size_t i) {
    return i < corners ? data.connectivity[i] : data.lines[i - corners];
  };
  const auto end = [size, alike](std::size_t i) {
    return static_cast<std::int32_t>(i < alike ? (i + 1) * size
                                               : alike * size + 2 * (i + 1 - alike));
  };
  const auto type = [kind = data.kind, alike](std::size_t i) {
    return static_cast<unsigned char>(vtk_type(i < alike ? kind : CellKind::line));
  };
  return {{"connectivity", 1, nullptr, int32_array(corners + data.lines.size(), corner)},
          {"offsets", 1, nullptr, int32_array(data.cells(), end)},
          {"types", 1, nullptr, bytes_array(data.cells(), type)}};
}

/// ` Scalars="bone" Vectors="displacement"`, where there are any.
std::string active_arrays(const std::vector<Element>& elements) {
  std::string scalars, vectors;
  for (const Element& element : elements) {
    const ArrayRole role = element.row ? element.row->role : ArrayRole::plain;
    if (role == ArrayRole::scalars) scalars = " Scalars=\"" + element.name + '"';
    if (role == ArrayRole::vectors) vectors = " Vectors=\"" + element.name + '"';
  }
  return scalars + vectors;
}

/// Text in memory, written as a NewFile is.
class TextInMemory {
 public:
  void write(const void* bytes, std::size_t count) {
    text_.append(static_cast<const char*>(bytes), count);
  }
  std::uint64_t extend(std::uint64_t count) {
    text_.resize(text_.size() + count);
    return text_.size() - count;
  }
  void write_at(std::uint64_t place, const void* bytes, std::size_t count) {
    std::memcpy(text_.data() + place, bytes, count);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

template <class File>
class VtuText {
 public:
  VtuText(File& file, const VtuFormat& format, double time)
      : file_(file), format_(format), time_(time) {}

  void add(std::string_view text) {
    pending_ += text;
    if (pending_.size() >= bytes_per_write) flush();
  }

  void add_group(const std::string& tag, const std::string& attributes,
                 const std::vector<Element>& elements) {
    add('<' + tag + attributes + ">\n");
    for (const Element& element : elements) add_element(element, tag == "FieldData");
    add("</" + tag + ">\n");
  }

  /// Raw data, in the order of its elements.
  void add_appended(const std::vector<const std::vector<Element>*>& groups) {
    if (format_.encoding != Encoding::raw) return;
    add("<AppendedData encoding=\"raw\">\n_");
    for (const auto* elements : groups)
      for (const Element& element : *elements) add_raw(element.values);
    add("\n</AppendedData>\n");
  }

  /// Writes the rest. Throws not written, also for what was being written meanwhile.
  void end() {
    flush();
    wait();
  }

 private:
  void flush() {
    file_.write(pending_.data(), pending_.size());
    pending_.clear();
  }

  void add_element(const Element& element, bool in_field) {
    if (format_.encoding == Encoding::raw) {
      add_opening(element, in_field, range_of(element.values, element.components));
    } else {
      EncodedArray text = encoded(element.values, element.components, format_.encoding);
      add_opening(element, in_field, text.range);
      add(text.counts);
      add_parts(std::move(text));
      add("\n");
    }
    if (element.row) {
      add("<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">\n");
      add(element.row->unit);
      add("\n</InformationKey>\n");
    }
    add("</DataArray>\n");
  }

  /// Large arrays are written by another thread while the next one is encoded.
  void add_parts(EncodedArray text) {
    flush();
    const std::uint64_t size = text.text_size() - text.counts.size(), begin = file_.extend(size);
    auto write = [this, begin, parts = std::move(text.parts)]() mutable {
      put_base64(std::move(parts), [&](std::size_t place, std::string_view piece) {
        file_.write_at(begin + place, piece.data(), piece.size());
      });
    };
    if (size < bytes_per_write || std::is_same_v<File, TextInMemory>) return write();
    wait();
    writing_ = std::async(std::launch::async, std::move(write));
  }

  void wait() {
    if (writing_.valid()) writing_.get();
  }

  void add_opening(const Element& element, bool in_field, const ValueRange& range) {
    const bool partial = element.row != nullptr && element.row->partial;
    const bool infinite = range.low <= range.high && !std::isfinite(range.high - range.low);
    if (format_.finite && (partial ? infinite : !range.finite)) throw not_finite(element.name);
    add("<DataArray" + attributes_of(element, in_field, range) + ">\n");
  }

  std::string attributes_of(const Element& element, bool in_field, const ValueRange& range) {
    const auto components = static_cast<std::size_t>(element.components);
    std::string text = xml_attribute("type", std::string(element.values.type));
    text += xml_attribute("Name", element.name);
    if (components > 1) text += xml_attribute("NumberOfComponents", std::to_string(components));
    for (std::size_t k = 0; element.row && k < element.row->components.size(); ++k)
      text += xml_attribute("ComponentName" + std::to_string(k),
                            std::string(element.row->components[k]));
    if (in_field)
      text += xml_attribute("NumberOfTuples", std::to_string(element.values.count / components));
    if (range.low <= range.high)
      text += xml_attribute("RangeMin", number_text(range.low)) +
              xml_attribute("RangeMax", number_text(range.high));
    if (format_.encoding != Encoding::raw) return text += xml_attribute("format", "binary");
    text += xml_attribute("format", "appended") + xml_attribute("offset", std::to_string(offset_));
    offset_ += sizeof(std::uint64_t) + element.values.bytes();
    return text;
  }

  void add_raw(const FileArray& values) {
    const std::uint64_t bytes = values.bytes();
    add({reinterpret_cast<const char*>(&bytes), sizeof bytes});
    const std::size_t at_once = bytes_per_write / values.size;
    for (std::size_t i = 0; i < values.count; i += at_once) {
      const std::size_t end = std::min(values.count, i + at_once), from = pending_.size();
      pending_.resize(from + (end - i) * values.size);
      values.put(i, end, reinterpret_cast<unsigned char*>(&pending_[from]));
      flush();
    }
  }

  Error not_finite(const std::string& name) const {
    return Error(Exit::unstable, "frame at " + number_text(time_) + " s: " + format_.series + ' ' +
                                     name +
                                     " has a value that is not finite; make solver.time_step "
                                     "shorter");
  }

  File& file_;
  const VtuFormat& format_;
  double time_;  ///< s
  std::string pending_;
  std::uint64_t offset_ = 0;   ///< offset of the next array in the appended data
  std::future<void> writing_;  ///< the last member: its thread uses the others
};

/// All parts up to the field data.
std::string vtu_opening(Encoding encoding) {
  std::string tag =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\"";
  if (encoding == Encoding::zlib) tag += " compressor=\"vtkZLibDataCompressor\"";
  if (encoding == Encoding::lz4) tag += " compressor=\"vtkLZ4DataCompressor\"";
  return tag + ">\n<UnstructuredGrid>\n";
}

/// All arrays of a piece.
struct Piece {
  const Dataset& data;
  std::vector<Element> of_points, of_cells, points, cells;

  Piece(const Dataset& given, const VtuFormat& format)
      : data(given),
        of_points(point_elements(data, format)),
        of_cells(elements_of(data.cell_columns, ArrayPlace::cell, format)),
        points{points_element(data, format)},
        cells(cell_elements(data)) {}

  template <class File>
  void add_to(VtuText<File>& text) const {
    text.add("<Piece NumberOfPoints=\"" + std::to_string(data.points.size()) +
             "\" NumberOfCells=\"" + std::to_string(data.cells()) + "\">\n");
    text.add_group("PointData", active_arrays(of_points), of_points);
    text.add_group("CellData", active_arrays(of_cells), of_cells);
    text.add_group("Points", "", points);
    text.add_group("Cells", "", cells);
    text.add("</Piece>\n");
  }
};

constexpr std::string_view end_of_grid = "</UnstructuredGrid>\n", end_of_file = "</VTKFile>\n";

}  // namespace

bool beyond_float32(const Points& points, double radius) {
  if (!(radius > 0)) return false;
  const double reach = float32_reach * radius;
  return parallel_sum(points.size(), points_per_piece, [&](std::size_t begin, std::size_t end) {
           return std::count_if(points.begin() + begin, points.begin() + end,
                                [&](const Vec3& p) { return p.cwiseAbs().maxCoeff() > reach; });
         }) > 0;
}

int vtk_type(CellKind kind) {
  switch (kind) {
    case CellKind::vertex:
      return 1;
    case CellKind::line:
      return 3;
    case CellKind::triangle:
      return 5;
    case CellKind::tetrahedron:
      return 10;
  }
  return 0;
}

void write_vtu(const std::filesystem::path& path, const Dataset& data, const VtuFormat& format) {
  const auto field = field_elements(data, format);
  const Piece piece(data, format);
  NewFile file(path);
  // ParaView 5.11 with an expat of 2024 or later, as in Debian 12 with updates, cannot read
  // appended data, not even in base64: only data in the elements is safe.
  VtuText text(file, format, data.time);
  text.add(vtu_beginning(format));
  text.add_group("FieldData", "", field);
  piece.add_to(text);
  text.add(end_of_grid);
  text.add_appended({&field, &piece.of_points, &piece.of_cells, &piece.points, &piece.cells});
  text.add(end_of_file);
  text.end();
  file.finish();
}

std::string vtu_beginning(const VtuFormat& format) { return vtu_opening(format.encoding); }

std::string vtu_piece(const Dataset& data, const VtuFormat& format) {
  TextInMemory memory;
  VtuText text(memory, format, data.time);
  Piece(data, format).add_to(text);
  text.end();
  return memory.take();
}

void finish_vtu(const std::filesystem::path& path, const Dataset& data, const VtuFormat& format) {
  TextInMemory memory;
  VtuText text(memory, format, data.time);
  text.add_group("FieldData", "", field_elements(data, format));
  text.add(end_of_grid);
  text.add(end_of_file);
  text.end();
  finish_parts(path, memory.take());
}

}  // namespace sinew
