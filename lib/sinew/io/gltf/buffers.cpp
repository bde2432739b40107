// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/buffers.h>

#include <vtkBase64Utilities.h>
#include <algorithm>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/container.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

Error too_short(std::int64_t size, std::size_t there) {
  return bad_input("a buffer says it has " + std::to_string(size) + " bytes, but " +
                       std::to_string(there) + " are there",
                   "export it again");
}

/// The first `size` bytes of what follows "data:".
std::string decoded(std::string_view data, std::size_t size) {
  const auto comma = data.find(',');
  if (comma == data.npos || !data.substr(0, comma).ends_with(";base64"))
    throw bad_input("a buffer's data is not in base64", "export it again");
  data.remove_prefix(comma + 1);
  if (data.size() / 4 * 3 + 3 < size) throw too_short(size, data.size() / 4 * 3);
  data = data.substr(0, (size + 2) / 3 * 4);
  std::string bytes(size, '\0');
  const std::size_t done = vtkBase64Utilities::DecodeSafely(
      reinterpret_cast<const unsigned char*>(data.data()), data.size(),
      reinterpret_cast<unsigned char*>(bytes.data()), bytes.size());
  if (done < size) throw too_short(size, done);
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

/// Whether a path without detours stays in the folder it starts from.
bool stays_below(const fs::path& path) {
  return !path.empty() && path.is_relative() && *path.begin() != "..";
}

std::string file_bytes(const std::string& uri, std::size_t size, const fs::path& folder) {
  const std::string name = without_percents(uri);
  const fs::path below = fs::path(name).lexically_normal();
  const bool scheme = uri.find(':') < uri.find('/');
  if (scheme || name.find('\0') != std::string::npos || !stays_below(below))
    throw bad_input("a buffer is to be found at " + shown(uri) + ", outside the file's own folder",
                    "put the .bin file beside it and export it so");
  std::string bytes = read_file(folder / below, most_gltf_bytes);
  if (bytes.size() < size) throw too_short(size, bytes.size()).with_context({(folder / below).string()});
  bytes.resize(size);
  return bytes;
}

std::string bytes_of(const GltfBuffer& buffer, const std::optional<std::string>& binary,
                     const fs::path& folder) {
  constexpr std::string_view data = "data:";
  const auto size = static_cast<std::size_t>(buffer.size);
  if (buffer.uri && buffer.uri->starts_with(data))
    return decoded(std::string_view(*buffer.uri).substr(data.size()), size);
  if (buffer.uri) return file_bytes(*buffer.uri, size, folder);
  if (!binary) throw bad_input("a buffer has no data", "export it again, without mesh compression");
  if (binary->size() < size) throw too_short(buffer.size, binary->size());
  return binary->substr(0, size);
}

}  // namespace

std::vector<char> gltf_bytes(const std::vector<GltfBuffer>& buffers,
                             const std::optional<std::string>& binary, const fs::path& folder) {
  std::int64_t total = 0;
  for (const GltfBuffer& buffer : buffers)
    total = std::min(total + buffer.size, most_gltf_bytes + 1);
  if (total > most_gltf_bytes)
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
