// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstring>

#include <sinew/core/text.h>
#include <sinew/mesh/detail/readers/mesh_readers.h>
#include <sinew/mesh/detail/readers/ply_header.h>

namespace sinew {
namespace {

std::string_view body_of(const MeshFile& file, const PlyHeader& header) {
  return std::string_view(file.content).substr(header.size);
}

/// The numbers of a text body: each element in a line of its own, or all one after the other.
class TextBody {
 public:
  TextBody(const MeshFile& file, const PlyHeader& header, bool by_lines)
      : file_(file),
        lines_(body_of(file, header)),
        words_(by_lines ? std::string_view() : lines_.rest(), header.lines + 1),
        before_(header.lines),
        by_lines_(by_lines) {}

  const MeshFile& file() const { return file_; }

  void begin_element() {
    if (!by_lines_) return;
    longer_ += !words_.next().empty();
    while (lines_.next())
      if (!Words(lines_.line()).next().empty()) break;
    words_ = Words(lines_.line(), before_ + lines_.number());
  }

  /// What is told after the last element.
  std::string warning() {
    longer_ += by_lines_ && !words_.next().empty();
    if (longer_ == 0) return {};
    return std::to_string(longer_) +
           " lines are longer than the header says; their last words are not read";
  }

  std::int64_t integer(const PlyType& type) {
    const std::string_view word = next();
    const auto value = integer_in(word);
    if (!value || *value < type.low || *value > type.high)
      throw broken(shown(word) + " is no number of type " + std::string(type.name));
    return *value;
  }

  double coordinate(const PlyType&) {
    const std::string_view word = next();
    const auto value = number_in(word);
    if (!value || !std::isfinite(*value)) throw broken(shown(word) + " is not a finite number");
    return *value;
  }

  void skip(const PlyType&) { next(); }

  Error broken(const std::string& what) const {
    return file_.broken(words_.line(), what, "correct the line or export the mesh again");
  }

 private:
  std::string_view next() {
    const std::string_view word = words_.next();
    if (word.empty())
      throw broken(by_lines_ ? "the line is shorter than the header says" : "the file ends early");
    return word;
  }

  const MeshFile& file_;
  Lines lines_;
  Words words_;
  int before_;  // lines of the header
  bool by_lines_;
  std::int64_t longer_ = 0;  // lines
};

/// The numbers of a binary body. Assumes a little-endian machine.
class BinaryBody {
 public:
  BinaryBody(const MeshFile& file, const PlyHeader& header)
      : file_(file), rest_(body_of(file, header)), swapped_(header.encoding == PlyEncoding::big) {}

  std::int64_t integer(const PlyType& type) {
    const auto value = next<std::int64_t>(type);
    return type.low < 0 && value > type.high ? value - 2 * (type.high + 1) : value;
  }

  double coordinate(const PlyType& type) {
    const double value = !type.real        ? static_cast<double>(integer(type))
                         : type.bytes == 4 ? static_cast<double>(next<float>(type))
                                           : next<double>(type);
    if (!std::isfinite(value)) throw broken("a coordinate is not finite");
    return value;
  }

  void skip(const PlyType& type) { take(type); }
  const MeshFile& file() const { return file_; }

  void begin_element() {}
  std::string warning() { return {}; }

  Error broken(const std::string& what) const {
    return file_.broken(0, what, "export the mesh again as PLY");
  }

 private:
  template <class Number>
  Number next(const PlyType& type) {
    char bytes[8] = {};
    std::memcpy(bytes, take(type), static_cast<std::size_t>(type.bytes));
    if (swapped_) std::reverse(bytes, bytes + type.bytes);
    Number value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }

  const char* take(const PlyType& type) {
    const auto bytes = static_cast<std::size_t>(type.bytes);
    if (rest_.size() < bytes) throw broken("the file ends early: it is cut short");
    const char* place = rest_.data();
    rest_.remove_prefix(bytes);
    return place;
  }

  const MeshFile& file_;
  std::string_view rest_;
  bool swapped_;
};

/// Reads the whole body. Each step consumes bytes or throws, so no count can cause long loops.
template <class Body>
class BodyReader {
 public:
  BodyReader(const PlyHeader& header, Body body) : header_(header), body_(std::move(body)) {
    for (const PlyElement& element : header.elements)
      if (element.vertices()) vertices_ += element.count;
  }

  PolygonSoup soup() {
    for (const PlyElement& element : header_.elements)
      for (std::int64_t i = 0; i < element.count; ++i) {
        body_.begin_element();
        if (element.vertices()) soup_.points.emplace_back(Vec3::Zero());
        for (const PlyProperty& property : element.properties) read(element, property);
      }
    soup_.warning = body_.warning();
    tell_of_left_out(body_.file(), left_out_, soup_);
    return std::move(soup_);
  }

 private:
  void read(const PlyElement& element, const PlyProperty& property) {
    const std::int64_t count = property.count ? body_.integer(*property.count) : 1;
    if (count < 0) throw body_.broken("a list has a negative length");
    if (element.vertices() && property.axis >= 0)
      soup_.points.back()[property.axis] = body_.coordinate(*property.type);
    else if (element.faces() && property.corners)
      face(*property.type, count);
    else if (element.strips() && property.corners)
      strips(*property.type, count);
    else
      for (std::int64_t i = 0; i < count; ++i) body_.skip(*property.type);
  }

  void face(const PlyType& type, std::int64_t count) {
    if (count == 0) throw body_.broken("a face has 0 corners");
    corners_.clear();
    for (std::int64_t i = 0; i < count; ++i) corners_.push_back(corner(body_.integer(type)));
    if (count < 3)
      ++left_out_;
    else
      soup_.polygons.emplace_back(corners_.begin(), corners_.end());
  }

  /// Triangle strips with -1 between them; every second triangle is turned the other way.
  void strips(const PlyType& type, std::int64_t count) {
    corners_.clear();
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t next = body_.integer(type);
      if (next == -1) {
        corners_.clear();
        continue;
      }
      corners_.push_back(corner(next));
      if (corners_.size() < 3) continue;
      const std::size_t last = corners_.size() - 1, odd = last % 2;
      soup_.polygons.push_back(
          {corners_[last - 2], corners_[last - 1 + odd], corners_[last - odd]});
    }
  }

  int corner(std::int64_t corner) const {
    if (corner < 0 || corner >= vertices_)
      throw body_.broken("a face names vertex " + std::to_string(corner) + " of " +
                         std::to_string(vertices_));
    return static_cast<int>(corner);
  }

  const PlyHeader& header_;
  Body body_;
  PolygonSoup soup_;
  std::vector<int> corners_;
  std::size_t left_out_ = 0;  // faces
  std::int64_t vertices_ = 0;
};

/// Whether the body has as many lines as elements.
bool has_line_of_each(const MeshFile& file, const PlyHeader& header) {
  std::int64_t left = 0;
  for (const PlyElement& element : header.elements) left += element.count;
  for (Lines lines(body_of(file, header)); left >= 0 && lines.next();)
    left -= !Words(lines.line()).next().empty();
  return left == 0;
}

/// Lines may be longer than the header says; or no line is that of an element.
PolygonSoup read_text(const MeshFile& file, const PlyHeader& header) {
  const auto read = [&](bool by_lines) {
    return BodyReader(header, TextBody(file, header, by_lines)).soup();
  };
  if (!has_line_of_each(file, header)) return read(false);
  try {
    return read(true);
  } catch (const Error&) {
    try {
      return read(false);
    } catch (const Error&) {
    }
    throw;
  }
}

/// The end of a header whose lines end in '\r' alone, before a binary body; 0 for others.
std::size_t end_of_old_header(std::string_view content) {
  constexpr std::string_view last = "end_header\r";
  if (!content.starts_with("ply\r") || content.substr(4, 1) == "\n") return 0;
  const std::size_t end = content.find(last);
  return end == content.npos ? 0 : end + last.size();
}

}  // namespace

PolygonSoup read_ply(const MeshFile& file) {
  if (const std::size_t end = end_of_old_header(file.content); end > 0) {
    MeshFile mended = file;
    std::replace(mended.content.data(), mended.content.data() + end, '\r', '\n');
    return read_ply(mended);
  }
  const PlyHeader header = ply_header(file);
  PolygonSoup soup = header.encoding == PlyEncoding::ascii
                         ? read_text(file, header)
                         : BodyReader(header, BinaryBody(file, header)).soup();
  refuse_too_many_points(file, soup.points.size());
  return soup;
}

}  // namespace sinew
