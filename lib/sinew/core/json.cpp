// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/json.h>

#include <algorithm>
#include <cstddef>

namespace sinew {
namespace {

/// Index of the quote that ends the string beginning at `at`.
std::size_t end_of_string(std::string_view json, std::size_t at) {
  for (++at; at < json.size() && json[at] != '"'; ++at)
    if (json[at] == '\\') ++at;
  return at;
}

}  // namespace

JsonExtent json_extent(std::string_view text) {
  JsonExtent extent;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') i = end_of_string(text, i);
    if (c == ']' || c == '}') --depth;
    if (c == '[' || c == '{') ++depth;
    if (c == '[' || c == '{' || c == ',') ++extent.values;
    extent.depth = std::max(extent.depth, depth);
  }
  return extent;
}

}  // namespace sinew
