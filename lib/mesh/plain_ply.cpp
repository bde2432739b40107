// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstring>

#include "core/words.h"

#include "mesh/mesh_text.h"
#include "mesh/plain_mesh.h"
#include "mesh/ply_header.h"

namespace sinew {
namespace {

/// The numbers of a text body.
class TextBody {
 public:
  TextBody(const MeshFile& file, const PlyHeader& header)
      : file_(file), words_(std::string_view(file.content).substr(header.size), header.lines + 1) {}

  std::int64_t integer(const PlyType& type) {
    const std::string_view word = next();
    const auto value = integer_in(word);
    if (!value || *value < type.low || *value > type.high)
      throw broken(shown(word) + " is no number of type " + std::string(type.name));
    return *value;
  }

  void skip(const PlyType& type) {
    if (!type.real) {
      integer(type);
      return;
    }
    const std::string_view word = next();
    if (!finite(word)) throw broken(shown(word) + " is not a finite number");
  }

  Error broken(const std::string& what) const {
    return file_.broken(words_.line(), what, "correct the line or export the mesh again");
  }

 private:
  std::string_view next() {
    const std::string_view word = words_.next();
    if (word.empty()) throw broken("the file ends early");
    return word;
  }

  const MeshFile& file_;
  Words words_;
};

/// The numbers of a binary body.
class BinaryBody {
 public:
  BinaryBody(const MeshFile& file, const PlyHeader& header)
      : file_(file),
        rest_(std::string_view(file.content).substr(header.size)),
        swapped_(header.encoding == PlyEncoding::big) {}

  std::int64_t integer(const PlyType& type) {
    char bytes[8] = {};  // the machine is little-endian, as all that run this are
    std::memcpy(bytes, take(type), static_cast<std::size_t>(type.bytes));
    if (swapped_) std::reverse(bytes, bytes + type.bytes);
    std::int64_t value;
    std::memcpy(&value, bytes, sizeof value);
    return type.low < 0 && value > type.high ? value - 2 * (type.high + 1) : value;
  }

  void skip(const PlyType& type) { take(type); }

  Error broken(const std::string& what) const {
    return file_.broken(0, what, "export the mesh again as PLY");
  }

 private:
  const char* take(const PlyType& type) {
    const auto bytes = static_cast<std::size_t>(type.bytes);
    if (rest_.size() < bytes) throw broken("the file ends early: it is cut short");
    const char* place = rest_.data();
    rest_.remove_prefix(bytes);
    return place;
  }

  const MeshFile& file_;
  std::string_view rest_;
  bool swapped_;
};

/// Goes through the whole body. Each step takes bytes or throws, so no count can lead astray.
template <class Body>
void check(const PlyHeader& header, Body body) {
  std::int64_t vertices = 0;
  for (const PlyElement& element : header.elements)
    if (element.vertices()) vertices += element.count;

  const auto index = [&](const PlyType& type) {
    const std::int64_t corner = body.integer(type);
    if (corner < 0 || corner >= vertices)
      throw body.broken("a face names vertex " + std::to_string(corner) + " of " +
                        std::to_string(vertices));
  };
  for (const PlyElement& element : header.elements)
    for (std::int64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) {
        const std::int64_t count = property.count ? body.integer(*property.count) : 1;
        if (count < 0) throw body.broken("a list has a negative length");
        const bool corners = element.faces() && property.name.starts_with("vertex_ind");
        for (std::int64_t j = 0; j < count; ++j)
          corners ? index(*property.type) : body.skip(*property.type);
      }
}

}  // namespace

std::string plain_ply(const MeshFile& file) {
  const PlyHeader header = ply_header(file);
  if (header.encoding == PlyEncoding::ascii)
    check(header, TextBody(file, header));
  else
    check(header, BinaryBody(file, header));
  return header.text() + file.content.substr(header.size);
}

}  // namespace sinew
