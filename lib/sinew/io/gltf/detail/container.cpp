// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/detail/container.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

#include <sinew/core/base64.h>
#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view glb_magic = "glTF";
constexpr std::size_t header_size = 12;                                    // magic, version, length
constexpr std::size_t chunk_header_size = 8;                               // length, kind
constexpr std::uint32_t json_kind = 0x4E4F534A, binary_kind = 0x004E4942;  // "JSON", "BIN\0"

/// A little-endian number; four bytes must be present.
std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) word = word << 8 | static_cast<unsigned char>(bytes[at + i]);
  return word;
}

std::string_view chunk_at(std::string_view file, std::size_t at) {
  if (file.size() - at < chunk_header_size)
    throw damaged_gltf("it is cut short in a chunk's header");
  const std::size_t size = word_at(file, at), left = file.size() - at - chunk_header_size;
  if (size > left)
    throw damaged_gltf("a chunk says it has " + std::to_string(size) + " bytes, but " +
                       std::to_string(left) + " are left");
  return file.substr(at + chunk_header_size, size);
}

/// `file_size`: of the whole file, of which these may be the first bytes.
void check_header(std::string_view file, std::uint64_t file_size) {
  if (file.size() < header_size) throw damaged_gltf("it is cut short in its header");
  const std::uint32_t version = word_at(file, 4), size = word_at(file, 8);
  if (version != 2)
    throw bad_input("it is a binary glTF of version " + std::to_string(version),
                    "export it as glTF 2.0");
  if (size != file_size)
    throw damaged_gltf("it says it has " + std::to_string(size) + " bytes, but has " +
                       std::to_string(file_size));
}

GltfContainer chunks_of(std::string_view file) {
  check_header(file, file.size());
  GltfContainer container;
  std::size_t count = 0;
  for (std::size_t at = header_size; at < file.size(); ++count) {
    const std::string_view chunk = chunk_at(file, at);
    const std::uint32_t kind = word_at(file, at + 4);
    if ((kind == json_kind) != (count == 0))
      throw damaged_gltf("its first chunk alone must be JSON");
    if (kind == json_kind) container.json = chunk;
    if (kind == binary_kind && count == 1) container.binary = chunk;
    at += chunk_header_size + chunk.size();
  }
  if (count == 0) throw damaged_gltf("it holds no chunks");
  return container;
}

Error too_short(std::int64_t size, std::size_t there) {
  return bad_input("a buffer says it has " + std::to_string(size) + " bytes, but " +
                       std::to_string(there) + " are there",
                   "export it again");
}

/// The first `size` bytes of a data URI, after "data:".
std::string decoded(std::string_view data, std::size_t size) {
  const auto comma = data.find(',');
  const Error not_base64 = bad_input("a buffer's data is not in base64", "export it again");
  if (comma == data.npos || !data.substr(0, comma).ends_with(";base64")) throw not_base64;
  data = data.substr(comma + 1, base64_size(size));
  std::string bytes(bytes_in_base64(data), '\0');
  if (bytes.size() < size) throw too_short(static_cast<std::int64_t>(size), bytes.size());
  if (!from_base64(data, bytes.size(), reinterpret_cast<unsigned char*>(bytes.data())))
    throw not_base64;
  bytes.resize(size);
  return bytes;
}

int hex_digit(char c) {
  constexpr std::string_view digits = "0123456789abcdef0123456789ABCDEF";
  const auto at = digits.find(c);
  return at == digits.npos ? -1 : static_cast<int>(at % 16);
}

/// "two%20words" -> "two words"
std::string without_percents(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
    const int low = high < 0 ? -1 : hex_digit(uri[i + 2]);
    text += low < 0 ? uri[i] : static_cast<char>(16 * high + low);
    if (low >= 0) i += 2;
  }
  return text;
}

std::string file_bytes(const std::string& uri, std::size_t size, const fs::path& folder) {
  const fs::path file = gltf_file_of(uri, folder);
  std::string bytes = read_head(file, size);
  if (bytes.size() < size) throw too_short(size, bytes.size()).with_context({file.string()});
  return bytes;
}

std::string bytes_of(const GltfBuffer& buffer, const std::optional<std::string>& binary,
                     const fs::path& folder) {
  constexpr std::string_view data = "data:";
  const auto size = static_cast<std::size_t>(buffer.size);
  if (buffer.uri && buffer.uri->starts_with(data))
    return decoded(std::string_view(*buffer.uri).substr(data.size()), size);
  if (buffer.uri) return file_bytes(*buffer.uri, size, folder);
  if (buffer.size == 0) return {};
  if (!binary) throw bad_input("a buffer has no data", "export it again, without mesh compression");
  if (binary->size() < size) throw too_short(buffer.size, binary->size());
  return binary->substr(0, size);
}

}  // namespace

fs::path gltf_file_of(const std::string& uri, const fs::path& folder) {
  const std::string name = without_percents(uri);
  const fs::path below = fs::path(name).lexically_normal();
  const bool scheme = uri.find(':') < uri.find('/');
  if (scheme || name.find('\0') != std::string::npos || !stays_below(below))
    throw bad_input("a buffer is to be found at " + shown(uri) + ", outside the file's own folder",
                    "put the .bin file beside it and export it so");
  return folder / below;
}

std::string read_gltf_file(const fs::path& path) {
  constexpr std::uint64_t enough = 4096;  // bytes
  std::string head = read_head(path, enough);
  std::error_code vanished;
  const std::uintmax_t reported = fs::file_size(path, vanished);
  const std::uint64_t size =
      vanished ? head.size() : std::max<std::uint64_t>(reported, head.size());
  const bool binary = head.starts_with(glb_magic);
  const auto first = head.find_first_not_of(" \t\r\n");
  if (size == head.size() || (!binary && first != std::string::npos && head[first] != '{'))
    return head;
  try {
    if (binary) check_header(head, size);
  } catch (const Error& error) {
    throw error.with_context({path.string()});
  }
  return read_file(path, max_gltf_bytes);
}

GltfContainer gltf_container(std::string file, const std::filesystem::path& extension) {
  const std::string kind = lower(extension.string());
  if (kind != ".gltf" && kind != ".glb" && kind != ".vrm")
    throw bad_input("its extension is " + shown(kind), "give a .gltf, .glb or .vrm file");
  if (file.empty()) throw damaged_gltf("it is empty");
  const bool binary = file.starts_with(glb_magic);
  if (binary && kind == ".gltf") throw bad_input("it is a binary glTF", "rename it to .glb");
  if (binary) return chunks_of(file);
  const auto first = file.find_first_not_of(" \t\r\n");
  const bool text = first != std::string::npos && file[first] == '{';
  if (kind == ".gltf") return {std::move(file), std::nullopt};
  if (text) throw bad_input("it is no binary glTF but text", "rename it to .gltf");
  throw damaged_gltf("it does not begin as a binary glTF does");
}

std::vector<char> gltf_bytes(std::vector<GltfBuffer>& buffers,
                             const std::optional<std::string>& binary, const fs::path& folder) {
  for (GltfBuffer& buffer : buffers)
    if (buffer.fallback && !buffer.uri && !(binary && &buffer == &buffers.front())) buffer.size = 0;
  std::int64_t total = 0;
  for (const GltfBuffer& buffer : buffers)
    total = std::min(total + buffer.size, max_gltf_bytes + 1);
  if (total > max_gltf_bytes)
    throw bad_input("its buffers say they have more than 2147483647 bytes",
                    "export it in parts or with fewer triangles");
  std::vector<char> bytes;
  for (const GltfBuffer& buffer : buffers) {
    const bool first = &buffer == &buffers.front();
    const std::string part = bytes_of(buffer, first ? binary : std::nullopt, folder);
    bytes.insert(bytes.end(), part.begin(), part.end());
  }
  return bytes;
}

}  // namespace sinew
