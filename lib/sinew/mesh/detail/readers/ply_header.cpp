// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/detail/readers/ply_header.h>

#include <algorithm>
#include <array>

#include <sinew/core/text.h>
#include <sinew/mesh/detail/readers/mesh_text.h>

namespace sinew {
namespace {

constexpr std::array<PlyType, 8> types = {{{"char", "int8", 1, false, -128, 127},
                                           {"uchar", "uint8", 1, false, 0, 255},
                                           {"short", "int16", 2, false, -32768, 32767},
                                           {"ushort", "uint16", 2, false, 0, 65535},
                                           {"int", "int32", 4, false, INT32_MIN, INT32_MAX},
                                           {"uint", "uint32", 4, false, 0, UINT32_MAX},
                                           {"float", "float32", 4, true, 0, 0},
                                           {"double", "float64", 8, true, 0, 0}}};
constexpr std::array<std::string_view, 3> encodings = {"ascii", "binary_little_endian",
                                                       "binary_big_endian"};

const PlyType* type_of(std::string_view word) {
  for (const PlyType& type : types)
    if (word == type.name || word == type.other) return &type;
  return nullptr;
}

class HeaderReader {
 public:
  explicit HeaderReader(const MeshFile& file) : file_(file), lines_(file.content) {}

  PlyHeader header() {
    if (!lines_.next() || Words(lines_.line()).next() != "ply")
      throw broken("the first line is not 'ply'");
    bool encoded = false;
    while (lines_.next()) {
      Words words(lines_.line());
      const std::string_view keyword = words.next();
      if (keyword == "end_header") {
        if (!encoded) throw broken("the header names no format");
        header_.size = file_.content.size() - lines_.rest().size();
        header_.lines = lines_.number();
        return header_;
      }
      if (keyword == "format")
        encoded = true, format(words);
      else if (keyword == "element")
        element(words);
      else if (keyword == "property")
        property(words);
      else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty())
        throw broken("a header has no keyword " + shown(keyword));
    }
    throw broken("the header has no end");
  }

 private:
  Error broken(const std::string& what) const {
    return file_.broken(lines_.number(), what, "export the mesh again as PLY");
  }

  void format(Words& words) {
    const std::string_view word = words.next(), version = words.next();
    const auto* found = std::find(encodings.begin(), encodings.end(), word);
    if (found == encodings.end()) throw broken("unknown format " + shown(word));
    if (!version.empty() && version != "1.0")
      throw broken("PLY of version " + shown(version) + ", not 1.0");
    header_.encoding = static_cast<PlyEncoding>(found - encodings.begin());
  }

  void element(Words& words) {
    const std::string name(words.next());
    const std::string_view word = words.next();
    const auto count = integer_in(word);
    if (!count || *count < 0 || *count > INT32_MAX)
      throw broken("the number of elements " + shown(word) + " is not between 0 and 2147483647");
    header_.elements.push_back({name, *count, {}});
  }

  void property(Words& words) {
    if (header_.elements.empty()) throw broken("a property precedes the first element");
    std::string_view word = words.next();
    PlyProperty property;
    if (word == "list") {
      property.count = type_of(words.next());
      if (!property.count || property.count->real)
        throw broken("a list's length must be an integer");
      word = words.next();
    }
    property.type = type_of(word);
    if (!property.type) throw broken("unknown type " + shown(word));
    property.name = words.next();
    if (property.name.empty()) throw broken("the property has no name");
    header_.elements.back().properties.push_back(property);
  }

  const MeshFile& file_;
  Lines lines_;
  PlyHeader header_;
};

void find_coordinates(const MeshFile& file, PlyElement& vertices) {
  constexpr std::array<const char*, 3> names = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    PlyProperty* property = vertices.find(names[axis]);
    if (!property || property->count)
      throw file.broken(0, std::string("the vertices have no number ") + names[axis],
                        "export the mesh again as PLY");
    property->axis = axis;
  }
}

void find_corners(const MeshFile& file, PlyElement& faces) {
  PlyProperty* property = faces.find("vertex_indices");
  if (!property) property = faces.find("vertex_index");
  if (!property || !property->count)
    throw file.broken(0, "the faces have no list vertex_indices", "export the mesh again as PLY");
  if (property->type->real)
    throw file.broken(0,
                      "the faces' vertex_indices are of type " + std::string(property->type->name),
                      "export them as integers");
  property->corners = true;
}

/// Marks the properties that the body's reader needs.
void find_mesh(const MeshFile& file, PlyHeader& header) {
  std::int64_t vertices = 0, faces = 0;
  for (PlyElement& element : header.elements) {
    if (element.properties.empty() && element.count > 0)
      throw file.broken(0, "the element " + shown(element.name) + " has no properties",
                        "export the mesh again as PLY");
    if (element.vertices()) vertices += element.count, find_coordinates(file, element);
    if (element.faces() || element.strips()) faces += element.count, find_corners(file, element);
  }
  if (vertices == 0 || faces == 0)
    throw file.broken(0, vertices ? "there are no faces, only points" : "there are no vertices",
                      "export the mesh with its faces");
}

}  // namespace

PlyProperty* PlyElement::find(std::string_view property) {
  for (PlyProperty& candidate : properties)
    if (candidate.name == property) return &candidate;
  return nullptr;
}

PlyHeader ply_header(const MeshFile& file) {
  PlyHeader header = HeaderReader(file).header();
  find_mesh(file, header);
  return header;
}

}  // namespace sinew
