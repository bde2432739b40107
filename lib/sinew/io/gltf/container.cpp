// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/container.h>

#include <cctype>
#include <string_view>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr std::string_view magic = "glTF";
constexpr std::size_t header_size = 12;                                    // magic, version, length
constexpr std::size_t chunk_header_size = 8;                               // length, kind
constexpr std::uint32_t json_kind = 0x4E4F534A, binary_kind = 0x004E4942;  // "JSON", "BIN\0"

Error damaged(const std::string& what) { return bad_input(what, "export it again"); }

/// A little-endian number; there must be four bytes.
std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) word = word << 8 | static_cast<unsigned char>(bytes[at + i]);
  return word;
}

std::string_view chunk_at(std::string_view file, std::size_t at) {
  if (file.size() - at < chunk_header_size) throw damaged("it is cut short in a chunk's header");
  const std::size_t size = word_at(file, at), left = file.size() - at - chunk_header_size;
  if (size > left)
    throw damaged("a chunk says it has " + std::to_string(size) + " bytes, but " +
                  std::to_string(left) + " are left");
  return file.substr(at + chunk_header_size, size);
}

void check_header(std::string_view file) {
  if (file.size() < header_size) throw damaged("it is cut short in its header");
  const std::uint32_t version = word_at(file, 4), size = word_at(file, 8);
  if (version != 2)
    throw bad_input("it is a binary glTF of version " + std::to_string(version),
                    "export it as glTF 2.0");
  if (size != file.size())
    throw damaged("it says it has " + std::to_string(size) + " bytes, but has " +
                  std::to_string(file.size()));
}

GltfContainer chunks_of(std::string_view file) {
  check_header(file);
  GltfContainer container;
  std::size_t count = 0;
  for (std::size_t at = header_size; at < file.size(); ++count) {
    const std::string_view chunk = chunk_at(file, at);
    const std::uint32_t kind = word_at(file, at + 4);
    if ((kind == json_kind) != (count == 0)) throw damaged("its first chunk alone must be JSON");
    if (kind == json_kind) container.json = chunk;
    if (kind == binary_kind && count == 1) container.binary = chunk;
    at += chunk_header_size + chunk.size();
  }
  if (count == 0) throw damaged("it holds no chunks");
  return container;
}

}  // namespace

GltfContainer gltf_container(std::string file, const std::filesystem::path& extension) {
  const std::string kind = lower(extension.string());
  if (kind != ".gltf" && kind != ".glb")
    throw bad_input("its extension is " + shown(kind), "give a .gltf or .glb file");
  if (file.empty()) throw damaged("it is empty");
  const bool binary = file.starts_with(magic);
  if (binary && kind == ".gltf") throw bad_input("it is a binary glTF", "rename it to .glb");
  if (binary) return chunks_of(file);
  const auto first = file.find_first_not_of(" \t\r\n");
  const bool text = first != std::string::npos && file[first] == '{';
  if (kind == ".gltf") return {std::move(file), std::nullopt};
  if (text) throw bad_input("it is no binary glTF but text", "rename it to .gltf");
  throw damaged("it does not begin as a binary glTF does");
}

}  // namespace sinew
