// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include <sinew/core/text.h>
#include <sinew/mesh/readers/mesh_readers.h>

namespace sinew {
namespace {

/// Joins lines that end in a backslash with the next; the number of lines is unchanged.
std::string joined(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  std::size_t swallowed = 0;
  for (Lines lines(text); lines.next();) {
    std::string_view line = lines.line();
    if (line.ends_with('\r')) line.remove_suffix(1);
    const bool continued = line.ends_with('\\');
    if (continued) line.remove_suffix(1);
    result.append(line);
    if (continued) {
      ++swallowed;
      result += ' ';
    } else {
      result.append(1 + std::exchange(swallowed, 0), '\n');
    }
  }
  return result;
}

class ObjReader {
 public:
  explicit ObjReader(const MeshFile& file) : file_(file) {}

  PolygonSoup soup() {
    if (file_.content.find('\\') == std::string::npos)
      read(file_.content);
    else
      read(joined(file_.content));
    if (soup_.points.empty() || soup_.polygons.empty())
      throw file_.broken(0, soup_.points.empty() ? "there are no vertices" : "there are no faces",
                         "export the mesh again as OBJ with its faces");
    if (largest_ > vertices())
      throw file_.broken(
          largest_line_,
          "the face names vertex " + std::to_string(largest_) + " of " + std::to_string(vertices()),
          "export the mesh again");
    return std::move(soup_);
  }

 private:
  std::int64_t vertices() const { return static_cast<std::int64_t>(soup_.points.size()); }

  void read(std::string_view text) {
    for (Lines lines(text); lines.next();) {
      Words words(lines.line(), lines.number());
      const std::string_view keyword = words.next();
      if (keyword == "v") soup_.points.push_back(next_point(words, file_));
      if (keyword == "f") face(words);
    }
    refuse_too_many_points(file_, soup_.points.size());
  }

  void face(Words& words) {
    corners_.clear();
    for (std::string_view word = words.next(); !word.empty(); word = words.next())
      corners_.push_back(static_cast<int>(corner(word, words.line()) - 1));
    if (corners_.size() < 3)
      throw file_.broken(words.line(),
                         "the face has " + std::to_string(corners_.size()) + " corners",
                         "a face needs 3 or more; export the mesh again");
    soup_.polygons.emplace_back(corners_.begin(), corners_.end());
  }

  /// The vertex of "7", "7/1", "7//3", "7/1/3" or "-2" (the last but one so far), from 1. Whether
  /// it exists is checked at the end: vertices may follow their faces.
  std::int64_t corner(std::string_view word, int line) {
    const auto index = integer_in(word.substr(0, word.find('/')));
    const std::int64_t from_one = index ? (*index < 0 ? *index + vertices() + 1 : *index) : 0;
    if (from_one < 1)
      throw file_.broken(line, "the face's corner " + shown(word) + " names no vertex",
                         "correct the line or export the mesh again");
    if (from_one > largest_) largest_ = from_one, largest_line_ = line;
    return from_one;
  }

  const MeshFile& file_;
  PolygonSoup soup_;
  std::vector<int> corners_;
  std::int64_t largest_ = 0;
  int largest_line_ = 0;
};

}  // namespace

PolygonSoup read_obj(const MeshFile& file) { return ObjReader(file).soup(); }

}  // namespace sinew
