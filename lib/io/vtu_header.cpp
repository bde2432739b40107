// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vtu_header.h"

#include <charconv>
#include <fstream>
#include <string>
#include <string_view>

#include "core/error.h"

namespace sinew {
namespace {

/// zlib, the strongest of the usual compressors, packs at most 1032 bytes into one.
constexpr std::uint64_t values_per_byte = 1032;
constexpr std::uint64_t most_components = 1000;

Error refused(const std::string& what) {
  return bad_input(what, "use a VTU file as sinew writes them");
}

/// The XML up to the appended data, which may be binary; the whole file when there is none.
std::string text_before_data(const std::filesystem::path& path) {
  constexpr std::string_view mark = "<AppendedData";
  std::ifstream file(path, std::ios::binary);
  if (!file) throw bad_input("it cannot be opened", "check the path and the permissions");
  std::string text, piece(1 << 16, '\0');
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())), file.gcount() > 0) {
    const std::size_t from = text.size() < mark.size() ? 0 : text.size() - mark.size();
    text.append(piece, 0, static_cast<std::size_t>(file.gcount()));
    if (const auto end = text.find(mark, from); end != std::string::npos)
      return text.substr(0, end);
  }
  return text;
}

/// The value of attribute `name` in an opening tag; "" when it is not there.
std::string_view attribute(std::string_view tag, std::string_view name) {
  const std::string start = std::string(name) + "=\"";
  const auto at = tag.find(start);
  if (at == std::string_view::npos) return {};
  tag.remove_prefix(at + start.size());
  return tag.substr(0, tag.find('"'));
}

void check_root(std::string_view text) {
  const auto root = text.find("<VTKFile");
  if (text.empty() || text.front() != '<' || root == std::string_view::npos || root > 4096)
    throw refused("it is not a VTK XML file");
  const std::string_view tag = text.substr(root, text.find('>', root) - root);
  if (const auto type = attribute(tag, "type"); type != "UnstructuredGrid")
    throw refused("it holds '" + std::string(type.substr(0, 40)) + "', not an UnstructuredGrid");
}

void check_count(std::string_view text, std::uint64_t most) {
  std::uint64_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count > most)
    throw refused("it declares a count of '" + std::string(text.substr(0, 40)) +
                  "', which its size cannot hold");
}

/// Every attribute NumberOf...="N".
void check_counts(std::string_view text, std::uint64_t bytes) {
  constexpr std::string_view start = "NumberOf";
  for (auto at = text.find(start); at != std::string_view::npos; at = text.find(start, at + 1)) {
    const std::string_view rest = text.substr(at);
    const auto quote = rest.find_first_of("\"'<>");
    if (quote == std::string_view::npos || quote > 40) continue;
    const bool components = rest.substr(0, quote).find("Components") != std::string_view::npos;
    const std::string_view value = rest.substr(quote + 1);
    check_count(value.substr(0, value.find_first_of("\"'<>")),
                components ? most_components : values_per_byte * bytes);
  }
}

}  // namespace

void check_vtu_header(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw bad_input("it is not a file", "check the path");
  const std::uint64_t bytes = std::filesystem::file_size(path, error);
  const std::string text = text_before_data(path);
  check_root(text);
  check_counts(text, bytes);
}

}  // namespace sinew
