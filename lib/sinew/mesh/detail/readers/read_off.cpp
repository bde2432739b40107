// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <sinew/core/text.h>
#include <sinew/mesh/detail/readers/mesh_readers.h>

namespace sinew {
namespace {

/// How the numbers of a vertex or face are told from those of the next.
enum class Layout {
  lines,   ///< each has a line of its own, which colors may end
  words,   ///< each has as many as the header says, in lines of any length
  wrapped  ///< each begins a line, and colors may end its last one
};

class OffReader {
 public:
  OffReader(const MeshFile& file, std::string_view text, Layout layout)
      : file_(file), lines_(text), words_(text), layout_(layout) {}

  PolygonSoup soup() {
    const auto [vertices, faces] = counts();
    const auto bytes = static_cast<std::int64_t>(file_.content.size());
    std::size_t left_out = 0;
    PolygonSoup soup;  // a vertex takes 6 bytes or more, a face 8
    soup.points.reserve(std::min(vertices, bytes / 6));
    soup.polygons.reserve(std::min(faces, bytes / 8));
    for (std::int64_t i = 0; i < vertices; ++i) {
      soup.points.push_back(next_point(row(), file_));
      if (layout_ == Layout::words)
        for (int k = 0; k < more_per_vertex_; ++k) words_.next();
      end_row();
    }
    refuse_too_many_points(file_, soup.points.size());
    for (std::int64_t i = 0; i < faces; ++i) {
      std::vector<int> polygon = face(vertices);
      if (polygon.size() < 3)
        ++left_out;
      else
        soup.polygons.push_back(std::move(polygon));
      end_row();
    }
    soup.warning = unread();
    tell_of_left_out(file_, left_out, soup);
    return soup;
  }

  bool has_counts() const { return has_counts_; }  ///< whether they were read

 private:
  /// The words of the next line that has any, or those of the whole rest.
  Words& row() {
    if (layout_ != Layout::lines) return words_;
    while (lines_.next())
      if (!Words(lines_.line()).next().empty())
        return words_ = Words(lines_.line(), lines_.number());
    throw ends_early(lines_.number());
  }

  void end_row() {
    if (layout_ == Layout::wrapped) words_.skip_line();
  }

  Error ends_early(int line) const {
    return file_.broken(line, "the file ends early", "export the mesh again");
  }

  std::array<std::int64_t, 2> counts() {
    row();
    std::string_view word = words_.next();
    if (is_off_keyword(word)) {
      word = after_keyword(word);
      if (word.empty()) word = words_.next();
      if (word.empty()) row(), word = words_.next();
    }
    const auto vertices = integer_in(word), faces = integer_in(words_.next());
    if (!vertices || !faces || *vertices < 1 || *faces < 1)
      throw file_.broken(words_.line(),
                         word == "BINARY"
                             ? "binary OFF cannot be read"
                             : "expected the numbers of vertices and faces, not " + shown(word),
                         "export the mesh as OFF text with its faces");
    if (layout_ != Layout::lines) words_.next();  // the number of edges
    end_row();
    has_counts_ = true;
    return {*vertices, *faces};
  }

  /// Takes in what the keyword says of the vertices. Returns what follows it without a blank.
  std::string_view after_keyword(std::string_view word) {
    const std::size_t end = lower(word).find("off");
    const std::string_view kinds = word.substr(0, end);
    if (kinds.find_first_of("4n") != kinds.npos)
      throw file_.broken(words_.line(), "OFF in more than 3 dimensions cannot be read",
                         "export the mesh as plain OFF");
    const auto has = [&](const char* kind) { return kinds.find(kind) != kinds.npos; };
    more_per_vertex_ = 3 * has("N") + 4 * has("C") + 2 * has("ST");
    return word.substr(end + 3);
  }

  std::vector<int> face(std::int64_t vertices) {
    Words& words = row();
    const std::string_view count = words.next();
    if (count.empty()) throw ends_early(words.line());
    const auto corners = integer_in(count);
    if (!corners || *corners < 1)
      throw file_.broken(words.line(), "the face has " + shown(count) + " corners",
                         "export the mesh again");
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

  /// What is told of the words after the last face. Throws where the words alone say what is what.
  std::string unread() {
    Words rest(layout_ == Layout::lines ? lines_.rest() : words_.rest());
    if (rest.next().empty()) return {};
    if (layout_ != Layout::lines)
      throw file_.broken(words_.line(), "the file goes on after its last face",
                         "export the mesh again");
    return "what follows the last face is not read: the file says fewer faces than it holds";
  }

  const MeshFile& file_;
  Lines lines_;
  Words words_;
  Layout layout_;
  int more_per_vertex_ = 0;  ///< words after the coordinates
  bool has_counts_ = false;
};

/// Blanks in the place of comments, which end with their lines.
std::string without_comments(std::string text) {
  bool comment = false;
  for (char& c : text) {
    comment = c != '\n' && (comment || c == '#');
    if (comment) c = ' ';
  }
  return text;
}

/// None where the file is not laid out so; its errors are told where `tells`.
std::optional<PolygonSoup> read_as(Layout layout, const MeshFile& file, std::string_view text,
                                   bool tells) {
  try {
    return OffReader(file, text, layout).soup();
  } catch (const Error&) {
    if (tells) throw;
    return std::nullopt;
  }
}

}  // namespace

bool is_off_keyword(std::string_view word) {
  const std::string_view kinds = word.substr(0, std::min(lower(word).find("off"), word.size()));
  const std::string_view after = word.substr(std::min(kinds.size() + 3, word.size()));
  return kinds.size() < word.size() && kinds.find_first_not_of("STCNn4stc") == kinds.npos &&
         after.find_first_not_of("0123456789") == after.npos;
}

PolygonSoup read_off(const MeshFile& file) {
  const std::string text = without_comments(file.content);
  OffReader lines(file, text, Layout::lines);
  try {
    return lines.soup();
  } catch (const Error&) {
    if (auto soup = read_as(Layout::words, file, text, false)) return *std::move(soup);
    if (auto soup = read_as(Layout::wrapped, file, text, !lines.has_counts()))
      return *std::move(soup);
    throw;
  }
}

}  // namespace sinew
