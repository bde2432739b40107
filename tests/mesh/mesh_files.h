// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes as the bytes of files, and a place to put them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <sinew/core/text.h>
#include <sinew/core/triangles.h>
#include <sinew/settings/settings.h>
#include "support/temp_folder.h"

namespace sinew::mesh_files {

inline std::string line(const Vec3& p) {
  return number_text(p.x()) + ' ' + number_text(p.y()) + ' ' + number_text(p.z()) + '\n';
}

inline std::string line(const std::vector<int>& polygon, int from) {
  std::string text;
  for (const int corner : polygon) text.append(" ").append(std::to_string(corner + from));
  return text + '\n';
}

inline std::string obj(const PolygonSoup& soup) {
  std::string text = "# a mesh\no body\n";
  for (const Vec3& p : soup.points) (text += "v ") += line(p);
  for (const auto& f : soup.polygons) (text += "f") += line(f, 1);
  return text;
}

inline std::string off(const PolygonSoup& soup) {
  std::string text = "OFF\n# a mesh\n" + std::to_string(soup.points.size()) + ' ' +
                     std::to_string(soup.polygons.size()) + " 0\n";
  for (const Vec3& p : soup.points) text += line(p);
  for (const auto& f : soup.polygons) text += std::to_string(f.size()) + line(f, 0);
  return text;
}

inline std::string ply_header(const PolygonSoup& soup, const std::string& format) {
  return "ply\nformat " + format + " 1.0\ncomment a mesh\nelement vertex " +
         std::to_string(soup.points.size()) +
         "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
         std::to_string(soup.polygons.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string ply(const PolygonSoup& soup) {
  std::string text = ply_header(soup, "ascii");
  for (const Vec3& p : soup.points) text += line(p);
  for (const auto& f : soup.polygons) text += std::to_string(f.size()) + line(f, 0);
  return text;
}

template <class Number>
void append(std::string& bytes, Number value, bool big = false) {
  std::string part(reinterpret_cast<const char*>(&value), sizeof value);
  if (big) std::reverse(part.begin(), part.end());
  bytes += part;
}

inline std::string ply_binary(const PolygonSoup& soup, bool big = false) {
  std::string bytes = ply_header(soup, big ? "binary_big_endian" : "binary_little_endian");
  for (const Vec3& p : soup.points)
    for (const double x : p) append(bytes, x, big);
  for (const auto& f : soup.polygons) {
    append(bytes, static_cast<std::uint8_t>(f.size()));
    for (const int corner : f) append(bytes, static_cast<std::int32_t>(corner), big);
  }
  return bytes;
}

/// STL has triangles only: fans of the polygons.
inline std::vector<std::array<Vec3, 3>> fans(const PolygonSoup& soup) {
  std::vector<std::array<Vec3, 3>> result;
  for (const auto& f : soup.polygons)
    for (std::size_t i = 1; i + 1 < f.size(); ++i)
      result.push_back({soup.points[f[0]], soup.points[f[i]], soup.points[f[i + 1]]});
  return result;
}

inline std::string stl(const PolygonSoup& soup, const std::string& first = "solid body\n") {
  std::string text = first;
  for (const auto& triangle : fans(soup)) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const Vec3& p : triangle) (text += "  vertex ") += line(p);
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid body\n";
}

inline std::string stl_binary(const PolygonSoup& soup, std::string header = "made by a test") {
  header.resize(80, '\0');
  const auto triangles = fans(soup);
  append(header, static_cast<std::uint32_t>(triangles.size()));
  for (const auto& triangle : triangles) {
    header.append(12, '\0');
    for (const Vec3& p : triangle)
      for (const double x : p) append(header, static_cast<float>(x));
    header.append(2, '\0');
  }
  return header;
}

/// A folder that goes away with the test.
class Folder {
 public:
  std::string path(const std::string& name) const { return (own_.path() / name).string(); }

  std::string file(const std::string& name, const std::string& content) const {
    std::filesystem::remove(path(name));  // to write over a file may wait for the disk
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }

 private:
  TempFolder own_;
};

/// The mesh at `path`, with all settings as they are by default.
inline BodyOptions body_at(const std::string& path) {
  BodyOptions body;
  body.mesh = path;
  return body;
}

}  // namespace sinew::mesh_files
