// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>

#include <sinew/core/text.h>
#include <sinew/mesh/detail/readers/mesh_readers.h>

namespace sinew {
namespace {

class OffReader {
 public:
  explicit OffReader(const MeshFile& file) : file_(file), lines_(file.content) {}

  PolygonSoup soup() {
    const auto [vertices, faces] = header();
    const auto bytes = static_cast<std::int64_t>(file_.content.size());
    PolygonSoup soup;  // a vertex takes 6 bytes or more, a face 8
    soup.points.reserve(std::min(vertices, bytes / 6));
    soup.polygons.reserve(std::min(faces, bytes / 8));
    for (std::int64_t i = 0; i < vertices; ++i) {
      Words words = line();
      soup.points.push_back(next_point(words, file_));
    }
    refuse_too_many_points(file_, soup.points.size());
    for (std::int64_t i = 0; i < faces; ++i) soup.polygons.push_back(face(vertices));
    return soup;
  }

 private:
  /// The words of the next line that is neither empty nor a comment.
  Words line() {
    while (lines_.next()) {
      const std::string_view text = lines_.line().substr(0, lines_.line().find('#'));
      if (!Words(text).next().empty()) return Words(text, lines_.number());
    }
    throw file_.broken(lines_.number(), "the file ends early", "export the mesh again");
  }

  std::array<std::int64_t, 2> header() {
    Words words = line();
    std::string_view word = words.next();
    if (word.ends_with("OFF")) {
      refuse_unread(word, words.line());
      word = words.next();
      if (word.empty()) word = (words = line()).next();
    }
    const auto vertices = integer_in(word), faces = integer_in(words.next());
    if (!vertices || !faces || *vertices < 1 || *faces < 1)
      throw file_.broken(words.line(),
                         word == "BINARY"
                             ? "binary OFF cannot be read"
                             : "expected the numbers of vertices and faces, not " + shown(word),
                         "export the mesh as OFF text with its faces");
    return {*vertices, *faces};
  }

  void refuse_unread(std::string_view keyword, int line) {
    keyword.remove_suffix(3);
    if (keyword.find_first_of("4n") != std::string_view::npos)
      throw file_.broken(line, "OFF in more than 3 dimensions cannot be read",
                         "export the mesh as plain OFF");
  }

  std::vector<int> face(std::int64_t vertices) {
    Words words = line();
    const std::string_view count = words.next();
    const auto corners = integer_in(count);
    if (!corners || *corners < 3)
      throw file_.broken(words.line(), "the face has " + shown(count) + " corners",
                         "a face needs 3 or more; export the mesh again");
    std::vector<int> polygon;
    polygon.reserve(std::min<std::int64_t>(*corners, 4));
    for (std::int64_t i = 0; i < *corners; ++i) polygon.push_back(corner(words, vertices));
    return polygon;
  }

  int corner(Words& words, std::int64_t vertices) {
    const std::string_view word = words.next();
    const auto index = integer_in(word);
    if (!index || *index < 0 || *index >= vertices)
      throw file_.broken(
          words.line(),
          word.empty() ? "the face has fewer corners than it says"
                       : "the face names vertex " + shown(word) + " of " + std::to_string(vertices),
          "vertices count from 0; export the mesh again");
    return static_cast<int>(*index);
  }

  const MeshFile& file_;
  Lines lines_;
};

}  // namespace

PolygonSoup read_off(const MeshFile& file) { return OffReader(file).soup(); }

}  // namespace sinew
