// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "core/words.h"

#include "mesh/mesh_text.h"
#include "mesh/plain_mesh.h"

namespace sinew {
namespace {

class OffGuard {
 public:
  explicit OffGuard(const MeshFile& file) : file_(file), lines_(file.content) {}

  std::string plain() {
    const auto [vertices, faces] = header();
    std::string body;
    for (std::int64_t i = 0; i < vertices; ++i) vertex(body);
    for (std::int64_t i = 0; i < faces; ++i) face(body, vertices);
    return "OFF\n" + std::to_string(vertices) + ' ' + std::to_string(faces) + " 0\n" + body;
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

  void vertex(std::string& body) {
    Words words = line();
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = words.next();
      if (!finite(word))
        throw file_.broken(words.line(),
                           word.empty()
                               ? "the vertex has fewer than 3 coordinates"
                               : "the coordinate " + shown(word) + " is not a finite number",
                           "correct the line or export the mesh again");
      body.append(word) += axis < 2 ? ' ' : '\n';
    }
  }

  void face(std::string& body, std::int64_t vertices) {
    Words words = line();
    const std::string_view count = words.next();
    const auto corners = integer_in(count);
    if (!corners || *corners < 3)
      throw file_.broken(words.line(), "the face has " + shown(count) + " corners",
                         "a face needs 3 or more; export the mesh again");
    body.append(count);
    for (std::int64_t i = 0; i < *corners; ++i) {
      const std::string_view word = words.next();
      const auto index = integer_in(word);
      if (!index || *index < 0 || *index >= vertices)
        throw file_.broken(words.line(),
                           word.empty() ? "the face has fewer corners than it says"
                                        : "the face names vertex " + shown(word) + " of " +
                                              std::to_string(vertices),
                           "vertices count from 0; export the mesh again");
      (body += ' ').append(word);
    }
    body += '\n';
  }

  const MeshFile& file_;
  Lines lines_;
};

}  // namespace

std::string plain_off(const MeshFile& file) { return OffGuard(file).plain(); }

}  // namespace sinew
