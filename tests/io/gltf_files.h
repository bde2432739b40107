// SPDX-License-Identifier: GPL-3.0-or-later
// glTF files of every form, made piece by piece.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <sinew/core/base64.h>
#include <sinew/core/triangles.h>
#include "support/scratch.h"

namespace sinew::gltf_files {

using Json = nlohmann::json;

template <class Number>
std::string raw(const std::vector<Number>& numbers) {
  std::string bytes(numbers.size() * sizeof(Number), '\0');
  if (!numbers.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

inline std::string raw(const Points& points) {
  std::vector<float> numbers;
  for (const Vec3& point : points)
    for (const double x : point) numbers.push_back(static_cast<float>(x));
  return raw(numbers);
}

template <class Number>
int component_type() {
  return sizeof(Number) == 1 ? 5121 : sizeof(Number) == 2 ? 5123 : 5125;
}

/// A document and the bytes of its one buffer. Each function adds an element, gives its index.
struct Gltf {
  Json json = {{"asset", {{"version", "2.0"}}}};
  std::string bytes;

  int add(const char* list, const Json& element) {
    json[list].push_back(element);
    return static_cast<int>(json[list].size()) - 1;
  }

  int view(const std::string& data, int stride = 0) {
    Json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}};
    if (stride > 0) view["byteStride"] = stride;
    bytes += data;
    bytes.resize((bytes.size() + 3) / 4 * 4);
    return add("bufferViews", view);
  }

  int accessor(int view, std::size_t count, const std::string& type, int component) {
    return add(
        "accessors",
        {{"bufferView", view}, {"count", count}, {"type", type}, {"componentType", component}});
  }

  int positions(const Points& points) {
    return accessor(view(raw(points)), points.size(), "VEC3", 5126);
  }

  int floats(const std::vector<float>& numbers, const std::string& type) {
    const std::size_t parts = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
    const int index = accessor(view(raw(numbers)), numbers.size() / parts, type, 5126);
    if (type == "SCALAR") {  // times: VTK wants to know how long they go on
      json["accessors"][index]["min"] = {*std::min_element(numbers.begin(), numbers.end())};
      json["accessors"][index]["max"] = {*std::max_element(numbers.begin(), numbers.end())};
    }
    return index;
  }

  int matrices(const std::vector<Eigen::Affine3d>& all) {
    std::vector<float> numbers;
    for (const Eigen::Affine3d& one : all)
      for (const double x : one.matrix().reshaped()) numbers.push_back(static_cast<float>(x));
    return floats(numbers, "MAT4");
  }

  template <class Number>
  int indices(const std::vector<Number>& corners) {
    return accessor(view(raw(corners)), corners.size(), "SCALAR", component_type<Number>());
  }

  int mesh(const std::vector<Json>& primitives) {
    return add("meshes", {{"primitives", primitives}});
  }

  int mesh(const PolygonSoup& triangles) {
    std::vector<std::uint32_t> corners;
    for (const auto& triangle : triangles.polygons)
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    const int points = positions(triangles.points);
    return mesh({{{"attributes", {{"POSITION", points}}}, {"indices", indices(corners)}}});
  }

  int node(const Json& node) { return add("nodes", node); }
  int scene(const std::vector<int>& roots) { return add("scenes", {{"nodes", roots}}); }
};

inline std::string word(std::size_t number) { return raw(std::vector{std::uint32_t(number)}); }

inline std::string chunk(const std::string& kind, std::string data, char padding) {
  data.resize((data.size() + 3) / 4 * 4, padding);
  return word(data.size()) + kind + data;
}

inline std::string glb(const std::string& json, const std::string& bytes) {
  std::string body = chunk("JSON", json, ' ');
  if (!bytes.empty()) body += chunk(std::string("BIN\0", 4), bytes, '\0');
  return "glTF" + word(2) + word(12 + body.size()) + body;
}

/// How a buffer goes with its document: as a data URI, in a file of its own, both in a .glb.
enum class Form { embedded, beside, packed };
inline constexpr Form forms[] = {Form::embedded, Form::beside, Form::packed};

/// Writes the document, whose buffer must be told apart from others only by being the first.
inline std::filesystem::path write(const std::filesystem::path& folder, Gltf gltf, Form form) {
  Json buffer = {{"byteLength", gltf.bytes.size()}};
  if (form == Form::embedded)
    buffer["uri"] = "data:application/octet-stream;base64," + base64(gltf.bytes);
  if (form == Form::beside) buffer["uri"] = "mesh.bin";
  if (!gltf.json.contains("buffers")) gltf.json["buffers"] = {buffer};
  const auto path = folder / (form == Form::packed ? "mesh.glb" : "mesh.gltf");
  if (form == Form::beside) put(folder / "mesh.bin", gltf.bytes);
  put(path, form == Form::packed ? glb(gltf.json.dump(), gltf.bytes) : gltf.json.dump());
  return path;
}

/// A tetrahedron with a right corner at the origin, outward.
inline PolygonSoup tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

/// One node that shows the tetrahedron.
inline Gltf one_tetrahedron() {
  Gltf gltf;
  gltf.mesh(tetrahedron());
  gltf.scene({gltf.node({{"mesh", 0}})});
  return gltf;
}

}  // namespace sinew::gltf_files
