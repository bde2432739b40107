// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstring>

#include <sinew/core/text.h>
#include <sinew/mesh/detail/readers/mesh_readers.h>

namespace sinew {
namespace {

// Binary STL: 80 arbitrary bytes, the number of triangles, then 12 floats and 2 bytes for each.
constexpr std::size_t header_bytes = 80, start = header_bytes + 4, triangle_bytes = 50;
constexpr std::size_t normal_bytes = 12;

std::uint32_t stated_triangles(std::string_view content) {
  std::uint32_t count;
  std::memcpy(&count, content.data() + header_bytes, sizeof count);
  return count;
}

/// "solid" may also begin a binary file, so the size decides, then the presence of zero bytes.
bool binary(std::string_view content) {
  if (content.size() < start) return false;
  if (content.size() == start + std::size_t{stated_triangles(content)} * triangle_bytes)
    return true;
  return content.find('\0') != std::string_view::npos || lower(Words(content).next()) != "solid";
}

/// Every three points form a triangle.
PolygonSoup soup_of(const MeshFile& file, Points points) {
  if (points.empty()) throw file.broken(0, "there are no triangles", "export the mesh again");
  refuse_too_many_points(file, points.size());
  PolygonSoup soup{std::move(points), {}};
  const int count = static_cast<int>(soup.points.size());
  soup.polygons.reserve(soup.points.size() / 3);
  for (int i = 0; i < count; i += 3) soup.polygons.push_back({i, i + 1, i + 2});
  return soup;
}

/// Whether the file ends where its attributes do, if the two bytes behind each triangle count those
/// that follow them. Most programs put colors there.
bool has_attributes(std::string_view content, std::size_t triangles) {
  std::size_t at = start;
  for (std::size_t i = 0; i < triangles; ++i) {
    if (content.size() - at < triangle_bytes) return false;
    std::uint16_t attributes;
    std::memcpy(&attributes, content.data() + at + triangle_bytes - sizeof attributes,
                sizeof attributes);
    at += triangle_bytes;
    if (content.size() - at < attributes) return false;
    at += attributes;
  }
  return at == content.size() && at > start + triangles * triangle_bytes;
}

PolygonSoup read_binary(const MeshFile& file) {
  const std::size_t triangles = stated_triangles(file.content);
  const std::size_t contained = (file.content.size() - start) / triangle_bytes;
  if (triangles > contained || (triangles == 0 && contained > 0))
    throw file.broken(0,
                      "the file says " + std::to_string(triangles) + " triangles but holds " +
                          std::to_string(contained),
                      "it is cut short or no STL: export the mesh again");
  if (has_attributes(file.content, triangles))
    throw file.broken(0,
                      "its triangles have " +
                          std::to_string(file.content.size() - start - triangles * triangle_bytes) +
                          " bytes of attributes between them, which are not read",
                      "export the mesh without attributes");
  Points points;
  points.reserve(3 * triangles);
  for (std::size_t i = 0; i < triangles; ++i) {
    Eigen::Matrix3f corners;  // one per column; machine and file are little-endian
    std::memcpy(corners.data(), file.content.data() + start + i * triangle_bytes + normal_bytes,
                sizeof corners);
    if (!corners.allFinite())
      throw file.broken(0, "triangle " + std::to_string(i) + " has a coordinate that is not finite",
                        "export the mesh again");
    for (int corner = 0; corner < 3; ++corner)
      points.emplace_back(corners.col(corner).cast<double>());
  }
  PolygonSoup soup = soup_of(file, std::move(points));
  if (triangles < contained)
    soup.warning = "the file says " + std::to_string(triangles) + " triangles but holds " +
                   std::to_string(contained) + ", of which the others are not read";
  return soup;
}

class StlText {
 public:
  explicit StlText(const MeshFile& file) : file_(file), words_(file.content) {}

  PolygonSoup soup() {
    if (lower(words_.next()) != "solid")
      throw file_.broken(0, "this is neither text nor binary STL", "export the mesh again");
    bool closed = false;
    std::string before;
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      std::string keyword = lower(word);
      if (keyword == "facet") facet();
      // Several solids may follow each other, with names between the keywords; some end in
      // "end solid".
      if (keyword == "facet" || keyword == "solid") closed = before == "end";
      if (keyword == "endsolid") closed = true;
      before = std::move(keyword);
    }
    if (!closed) throw cut_short();
    return soup_of(file_, std::move(points_));
  }

 private:
  Error cut_short() const {
    return file_.broken(words_.line(), "the file ends without 'endsolid'",
                        "it is cut short: export the mesh again");
  }

  void facet() {
    const std::size_t before = points_.size();
    for (std::string keyword; keyword != "endfacet";) {
      const std::string_view word = words_.next();
      if (word.empty()) throw cut_short();
      keyword = lower(word);
      if (keyword == "vertex") points_.push_back(next_point(words_, file_));
    }
    const std::size_t corners = points_.size() - before;
    if (corners != 3)
      throw file_.broken(words_.line(), "the facet has " + std::to_string(corners) + " corners",
                         "STL knows triangles only: export the mesh again");
  }

  const MeshFile& file_;
  Words words_;
  Points points_;
};

}  // namespace

PolygonSoup read_stl(const MeshFile& file) {
  return binary(file.content) ? read_binary(file) : StlText(file).soup();
}

}  // namespace sinew
