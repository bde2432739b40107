// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "core/words.h"

#include "mesh/mesh_text.h"
#include "mesh/plain_mesh.h"

namespace sinew {
namespace {

/// Joins lines that end in a backslash with their next; the number of lines stays the same.
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

class ObjGuard {
 public:
  explicit ObjGuard(const MeshFile& file) : file_(file) {}

  std::string plain() {
    const std::string text = joined(file_.content);
    for (Lines lines(text); lines.next();) {
      Words words(lines.line(), lines.number());
      const std::string_view keyword = words.next();
      if (keyword == "v") vertex(words);
      if (keyword == "f") face(words);
    }
    if (vertices_ == 0 || faces_ == 0)
      throw file_.broken(0, "there are no " + std::string(vertices_ ? "faces" : "vertices"),
                         "export the mesh again as OBJ with its faces");
    if (largest_ > vertices_)
      throw file_.broken(
          largest_line_,
          "the face names vertex " + std::to_string(largest_) + " of " + std::to_string(vertices_),
          "export the mesh again");
    return std::move(plain_);
  }

 private:
  void vertex(Words& words) {
    plain_ += 'v';
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = words.next();
      if (!finite(word))
        throw file_.broken(words.line(),
                           word.empty()
                               ? "the vertex has fewer than 3 coordinates"
                               : "the coordinate " + shown(word) + " is not a finite number",
                           "correct the line or export the mesh again");
      (plain_ += ' ').append(word);
    }
    plain_ += '\n';
    ++vertices_;
  }

  void face(Words& words) {
    plain_ += 'f';
    int corners = 0;
    for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++corners)
      (plain_ += ' ') += std::to_string(corner(word, words.line()));
    plain_ += '\n';
    ++faces_;
    if (corners < 3)
      throw file_.broken(words.line(), "the face has " + std::to_string(corners) + " corners",
                         "a face needs 3 or more; export the mesh again");
  }

  /// The vertex of "7", "7/1", "7//3", "7/1/3" or "-2" (the last but one so far), from 1.
  std::int64_t corner(std::string_view word, int line) {
    const auto index = integer_in(word.substr(0, word.find('/')));
    const std::int64_t from_one = index ? (*index < 0 ? *index + vertices_ + 1 : *index) : 0;
    if (from_one < 1)
      throw file_.broken(line, "the face's corner " + shown(word) + " names no vertex",
                         "correct the line or export the mesh again");
    if (from_one > largest_) largest_ = from_one, largest_line_ = line;
    return from_one;
  }

  const MeshFile& file_;
  std::string plain_;
  std::int64_t vertices_ = 0, faces_ = 0, largest_ = 0;
  int largest_line_ = 0;
};

}  // namespace

std::string plain_obj(const MeshFile& file) { return ObjGuard(file).plain(); }

}  // namespace sinew
