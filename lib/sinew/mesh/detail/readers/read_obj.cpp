// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <sinew/core/text.h>
#include <sinew/mesh/detail/readers/mesh_readers.h>

namespace sinew {
namespace {

bool begins_comment(std::string_view word) { return word.starts_with('#'); }

/// Whether a line is of its own, whatever ends the one before it.
bool begins_with_keyword(std::string_view line) {
  constexpr std::array<std::string_view, 10> keywords = {"v", "vt", "vn", "f",      "l",
                                                         "p", "o",  "s",  "usemtl", "mtllib"};
  const std::string_view word = Words(line).next();
  return begins_comment(word) ||
         std::find(keywords.begin(), keywords.end(), word) != keywords.end();
}

bool has_comment(std::string_view line) {
  Words words(line);
  std::string_view word = words.next();
  while (!word.empty() && !begins_comment(word)) word = words.next();
  return !word.empty();
}

struct Joined {
  std::string text;
  int ends = 0;  ///< lines that end in a backslash, but not in the next line
};

/// Joins lines that end in a backslash with the next; the number of lines is unchanged. Comments
/// end with their line, and names of files and materials before a keyword keep their backslash.
Joined joined(std::string_view text) {
  Joined result;
  result.text.reserve(text.size());
  std::size_t swallowed = 0;
  for (Lines lines(text); lines.next();) {
    std::string_view line = lines.line();
    if (line.ends_with('\r')) line.remove_suffix(1);
    Lines after = lines;
    const bool marked = line.ends_with('\\') && !has_comment(line);
    const bool continued = marked && !(after.next() && begins_with_keyword(after.line()));
    result.ends += marked && !continued;
    if (marked && (continued || line.ends_with(" \\"))) line.remove_suffix(1);
    result.text.append(line);
    if (continued) {
      ++swallowed;
      result.text += ' ';
    } else {
      result.text.append(1 + std::exchange(swallowed, 0), '\n');
    }
  }
  return result;
}

class ObjReader {
 public:
  ObjReader(const MeshFile& file, PolygonLook* look) : file_(file), look_(look) {}

  PolygonSoup soup() {
    if (file_.content.find('\\') == std::string::npos)
      read(file_.content);
    else
      read_joined(joined(file_.content));
    tell_of_left_out(file_, left_out_, soup_);
    if (soup_.points.empty() || soup_.polygons.empty())
      throw file_.broken(0, soup_.points.empty() ? "there are no vertices" : "there are no faces",
                         "export the mesh again as OBJ with its faces");
    if (largest_ > vertices())
      throw file_.broken(
          largest_line_,
          "the face names vertex " + std::to_string(largest_) + " of " + std::to_string(vertices()),
          "export the mesh again");
    if (has_free_form_)
      soup_.warning += std::string(soup_.warning.empty() ? "" : "; ") +
                       "free-form surfaces (surf) are not read; export them as polygons";
    return std::move(soup_);
  }

 private:
  std::int64_t vertices() const { return static_cast<std::int64_t>(soup_.points.size()); }

  void read(std::string_view text) {
    for (Lines lines(text); lines.next();) {
      Words words(lines.line(), lines.number());
      const std::string_view keyword = words.next();
      if (keyword == "v") soup_.points.push_back(next_point(words, file_));
      if (keyword == "f" || keyword == "fo") face(words);
      has_free_form_ = has_free_form_ || keyword == "surf";
      if (look_) look_at(keyword, lines.line(), words);
    }
    refuse_too_many_points(file_, soup_.points.size());
  }

  void read_joined(const Joined& joined) {
    read(joined.text);
    if (joined.ends == 0) return;
    soup_.warning = "lines that end in a backslash before the keyword of another line: " +
                    std::to_string(joined.ends) + "; they are read as two lines";
  }

  /// The lines of a look.
  void look_at(std::string_view keyword, std::string_view line, Words& words) {
    SurfaceLook& look = look_->look;
    if (keyword == "vt") {
      const double u = finite(words), v = finite(words);
      look.coordinates.push_back({u, v});
    }
    if (keyword == "vn") {
      Vec3 normal;
      for (double& part : normal) part = finite(words);
      look.normals.push_back(direction_of(normal));
    }
    if (keyword == "mtllib") look.libraries.push_back(after(keyword, line));
    SurfaceLook::Part part = look.parts.empty() ? SurfaceLook::Part() : look.parts.back();
    if (keyword == "o") part.object = after(keyword, line);
    if (keyword == "g") part.group = after(keyword, line);
    if (keyword == "usemtl") part.material = after(keyword, line);
    if (keyword == "o" || keyword == "g" || keyword == "usemtl")
      look.parts.push_back(std::move(part));
  }

  /// The next word's number; 0 where it is none.
  static double finite(Words& words) {
    const double number = number_in(words.next()).value_or(0);
    return std::isfinite(number) ? number : 0;
  }

  /// The rest of a line, without the spaces around it.
  static std::string after(std::string_view keyword, std::string_view line) {
    line.remove_prefix(line.find(keyword) + keyword.size());
    while (!line.empty() && line.back() <= ' ') line.remove_suffix(1);
    while (!line.empty() && line.front() <= ' ') line.remove_prefix(1);
    return std::string(line);
  }

  void face(Words& words) {
    corners_.clear();
    if (look_) {
      look_->look.part.push_back(static_cast<int>(look_->look.parts.size()) - 1);
      look_->corners.emplace_back();
      look_->normal_corners.emplace_back();
    }
    for (std::string_view word = words.next(); !word.empty() && !begins_comment(word);
         word = words.next()) {
      corners_.push_back(static_cast<int>(corner(word, words.line()) - 1));
      if (!look_) continue;
      look_->corners.back().push_back(index_in(word, 1, look_->look.coordinates.size()));
      look_->normal_corners.back().push_back(index_in(word, 2, look_->look.normals.size()));
    }
    if (corners_.size() < 3) return leave_out();
    soup_.polygons.emplace_back(corners_.begin(), corners_.end());
  }

  void leave_out() {
    ++left_out_;
    if (!look_) return;
    look_->look.part.pop_back();
    look_->corners.pop_back();
    look_->normal_corners.pop_back();
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

  /// The index after so many slashes of "7/1/3", from 0; -1 for none. Negative ones count back
  /// from the last of those `there`.
  static int index_in(std::string_view word, int slashes, std::size_t there) {
    for (; slashes > 0; --slashes) {
      const std::size_t slash = std::min(word.find('/'), word.size());
      word.remove_prefix(std::min(slash + 1, word.size()));
    }
    const auto index = integer_in(word.substr(0, word.find('/')));
    const auto last = static_cast<std::int64_t>(there);
    const std::int64_t from_one = index ? (*index < 0 ? *index + last + 1 : *index) : 0;
    return from_one < 1 || from_one > INT32_MAX ? -1 : static_cast<int>(from_one - 1);
  }

  const MeshFile& file_;
  PolygonLook* look_;
  PolygonSoup soup_;
  std::vector<int> corners_;
  std::size_t left_out_ = 0;  // faces
  std::int64_t largest_ = 0;
  int largest_line_ = 0;
  bool has_free_form_ = false;
};

}  // namespace

PolygonSoup read_obj(const MeshFile& file) { return ObjReader(file, nullptr).soup(); }

PolygonSoup read_obj(const MeshFile& file, PolygonLook& look) {
  return ObjReader(file, &look).soup();
}

}  // namespace sinew
