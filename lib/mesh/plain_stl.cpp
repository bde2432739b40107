// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/words.h"

#include "mesh/mesh_text.h"
#include "mesh/plain_mesh.h"

namespace sinew {
namespace {

// Binary STL: 80 bytes of anything, the number of triangles, then 12 floats and 2 bytes for each.
constexpr std::size_t header_bytes = 80, start = header_bytes + 4, triangle_bytes = 50;
constexpr std::size_t normal_bytes = 12, floats = 9;

std::uint32_t stated_triangles(std::string_view content) {
  std::uint32_t count;
  std::memcpy(&count, content.data() + header_bytes, sizeof count);
  return count;
}

/// "solid" may also begin a binary file, so the size decides, then whether there are zero bytes.
bool binary(std::string_view content) {
  if (content.size() < start) return false;
  if (content.size() == start + std::size_t{stated_triangles(content)} * triangle_bytes)
    return true;
  return content.find('\0') != std::string_view::npos || lower(Words(content).next()) != "solid";
}

void refuse_not_finite(const MeshFile& file, std::uint32_t triangles) {
  for (std::size_t i = 0; i < triangles; ++i) {
    float corners[floats];
    std::memcpy(corners, file.content.data() + start + i * triangle_bytes + normal_bytes,
                sizeof corners);
    if (!std::all_of(corners, corners + floats, [](float value) { return std::isfinite(value); }))
      throw file.broken(0, "triangle " + std::to_string(i) + " has a coordinate that is not finite",
                        "export the mesh again");
  }
}

std::string plain_binary(const MeshFile& file) {
  const std::uint32_t triangles = stated_triangles(file.content);
  const std::size_t held = (file.content.size() - start) / triangle_bytes;
  if (triangles > held)
    throw file.broken(0,
                      "the file says " + std::to_string(triangles) + " triangles but holds " +
                          std::to_string(held),
                      "it is cut short or no STL: export the mesh again");
  if (triangles == 0) throw file.broken(0, "there are no triangles", "export the mesh again");
  refuse_not_finite(file, triangles);
  // A header of "solid" would make CGAL take it for text.
  return std::string(header_bytes, '\0') +
         file.content.substr(header_bytes, start - header_bytes + triangles * triangle_bytes);
}

class StlText {
 public:
  explicit StlText(const MeshFile& file) : file_(file), words_(file.content) {}

  std::string plain() {
    if (lower(words_.next()) != "solid")
      throw file_.broken(0, "this is neither text nor binary STL", "export the mesh again");
    bool closed = false;
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      const std::string keyword = lower(word);
      if (keyword == "facet") facet();
      // Several solids may follow each other; names stand between the keywords.
      if (keyword == "facet" || keyword == "solid") closed = false;
      if (keyword == "endsolid") closed = true;
    }
    if (!closed) throw cut_short();
    if (plain_.empty()) throw file_.broken(0, "there are no triangles", "export the mesh again");
    return "solid\n" + plain_ + "endsolid\n";
  }

 private:
  Error cut_short() const {
    return file_.broken(words_.line(), "the file ends without 'endsolid'",
                        "it is cut short: export the mesh again");
  }

  void facet() {
    plain_ += "facet outer loop";
    int corners = 0;
    for (std::string keyword; keyword != "endfacet";) {
      const std::string_view word = words_.next();
      if (word.empty()) throw cut_short();
      keyword = lower(word);
      if (keyword == "vertex") ++corners, corner();
    }
    if (corners != 3)
      throw file_.broken(words_.line(), "the facet has " + std::to_string(corners) + " corners",
                         "STL knows triangles only: export the mesh again");
    plain_ += " endloop endfacet\n";
  }

  void corner() {
    plain_ += " vertex";
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = words_.next();
      if (word.empty()) throw cut_short();
      if (!finite(word))
        throw file_.broken(words_.line(),
                           "the coordinate " + shown(word) + " is not a finite number",
                           "correct the line or export the mesh again");
      (plain_ += ' ').append(word);
    }
  }

  const MeshFile& file_;
  Words words_;
  std::string plain_;
};

}  // namespace

std::string plain_stl(const MeshFile& file) {
  return binary(file.content) ? plain_binary(file) : StlText(file).plain();
}

}  // namespace sinew
