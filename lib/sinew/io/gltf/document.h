// SPDX-License-Identifier: GPL-3.0-or-later
// The shapes, nodes, skins and animations of a glTF 2.0 file as plain values. Names and defaults
// are those of the glTF 2.0 Specification (Khronos Group); -1 is no index.
//
//     const GltfDocument document = gltf_document(json);
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/error.h>

namespace sinew {

struct GltfBuffer {
  std::int64_t size = 0;           ///< bytes
  std::optional<std::string> uri;  ///< none: the binary chunk of a .glb
  bool fallback = false;           ///< stands for what EXT_meshopt_compression packs, without data
};

/// How EXT_meshopt_compression packs a view.
struct GltfPacked {
  int buffer = -1;
  std::int64_t offset = 0, size = 0;   ///< bytes
  std::int64_t stride = 0, count = 0;  ///< bytes of an element, elements
  std::string mode, filter;
};

struct GltfView {
  int buffer = -1;
  std::int64_t offset = 0, size = 0;  ///< bytes
  std::int64_t stride = 0;            ///< bytes from element to element, 0 where contiguous
  std::optional<GltfPacked> packed = {};
};

/// Number types with OpenGL's codes.
enum class GltfNumber { int8 = 5120, uint8, int16, uint16, uint32 = 5125, float32 };

/// Elements of an accessor that replace individual others.
struct GltfSparse {
  std::int64_t count = 0;
  int index_view = -1, value_view = -1;
  std::int64_t index_offset = 0, value_offset = 0;  ///< bytes
  GltfNumber index_number = GltfNumber::uint32;
};

struct GltfAccessor {
  int view = -1;
  std::int64_t offset = 0;  ///< bytes
  std::int64_t count = 0;   ///< elements
  GltfNumber number = GltfNumber::float32;
  std::string type;  ///< "SCALAR", "VEC3", ...
  bool normalized = false;
  std::optional<GltfSparse> sparse;
};

enum class GltfMode {
  points,
  lines,
  line_loop,
  line_strip,
  triangles,
  triangle_strip,
  triangle_fan
};

struct GltfPrimitive {
  GltfMode mode = GltfMode::triangles;
  int indices = -1;
  int material = -1;
  std::map<std::string, int> attributes;        ///< "POSITION", ... -> accessor
  int draco = -1;                               ///< view of KHR_draco_mesh_compression, if any
  std::map<std::string, int> draco_attributes;  ///< "POSITION", ... -> id in it
  std::vector<int> targets;  ///< accessors of what morph targets add to points, -1 for none

  /// Whether it has triangles to draw.
  bool is_surface() const { return mode >= GltfMode::triangles && attributes.contains("POSITION"); }
  int positions() const { return attributes.at("POSITION"); }  ///< accessor of a surface's points
};

struct GltfMesh {
  std::string name;
  std::vector<GltfPrimitive> primitives;
  std::vector<double> weights;  ///< weights of morph targets at rest, or none
};

struct GltfNode {
  std::string name;
  std::vector<int> children;
  int mesh = -1, skin = -1;
  std::vector<double> matrix;  ///< 16, column by column, or none: then the other three
  std::vector<double> translation, rotation, scale;  ///< 3, 4 (x y z w, unit length), 3, or none
  std::vector<double> weights;                       ///< in place of the mesh's, or none
};

/// The nodes that move a mesh.
struct GltfSkin {
  std::vector<int> joints;  ///< nodes; JOINTS_n of a mesh are indices into this list
  int binds = -1;           ///< accessor of the inverse bind matrices; none: all are the identity
  int root = -1;            ///< "skeleton", a node; informative only
};

enum class GltfInterpolation { step, linear, cubic };

/// Values over time.
struct GltfSampler {
  int times = -1, values = -1;  ///< accessors; cubic: in-tangent, value, out-tangent for each time
  GltfInterpolation interpolation = GltfInterpolation::linear;
};

enum class GltfPath { translation, rotation, scale, weights, other };

/// One property of a node that follows a sampler.
struct GltfChannel {
  int sampler = -1;
  int node = -1;
  GltfPath path = GltfPath::other;
};

struct GltfAnimation {
  std::string name;
  std::vector<GltfSampler> samplers;
  std::vector<GltfChannel> channels;  ///< channels that move nodes
};

struct GltfDocument {
  std::string version, min_version;  ///< min_version: "" where the file names none
  std::vector<std::string> extensions_required;
  std::vector<GltfBuffer> buffers;
  std::vector<GltfView> views;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfMesh> meshes;
  std::vector<GltfNode> nodes;
  std::vector<GltfSkin> skins;
  std::vector<GltfAnimation> animations;
  std::vector<std::vector<int>> scenes;  ///< the topmost nodes of each
  int scene = -1;                        ///< the default one
  std::vector<int> humanoid;             ///< nodes that VRM names as bones; -1: none
  bool moves_morphs = false;             ///< whether an animation changes weights of morph targets
};

/// Bytes of one number, numbers of one element ("VEC3": 3; 0 for an unknown type).
int size_of(GltfNumber number);
int components_of(std::string_view type);

/// Upper bound on lengths and indices in a file, in bytes or elements: 32 bits with a sign.
inline constexpr std::int64_t max_gltf_bytes = 2147483647;

/// Checks the form of each field it reads (type, length, range), not what indices refer to. Throws
/// bad input (without the path) naming the field, and for JSON that is damaged, nested more than
/// 100 deep or holds more than 4 million values.
GltfDocument gltf_document(std::string_view json);

inline Error damaged_gltf(const std::string& what) { return bad_input(what, "export it again"); }

/// nth("nodes", 3) is "nodes[3]".
inline std::string nth(std::string_view what, std::size_t index) {
  return std::string(what) + '[' + std::to_string(index) + ']';
}

template <class Element>
void check_index(int index, const std::vector<Element>& elements, const std::string& user,
                 const char* what) {
  if (index < 0 || static_cast<std::size_t>(index) >= elements.size())
    throw damaged_gltf(user + " names " + what + ' ' + std::to_string(index) + " of " +
                       std::to_string(elements.size()));
}

}  // namespace sinew
