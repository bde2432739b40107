// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/json.h>

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>

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

template <class Json>
Json parsed_json(std::string_view text) {
  return Json::parse(text, nullptr, false);
}

template <class Json>
Json own_json(std::string_view text) {
  constexpr int max_depth = 16;  // levels: sinew nests no deeper
  if (json_extent(text).depth > max_depth) return Json(Json::value_t::discarded);
  return parsed_json<Json>(text);
}

template <class Json>
std::string json_text(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

using nlohmann::json, nlohmann::ordered_json;
template json parsed_json(std::string_view);
template json own_json(std::string_view);
template std::string json_text(const json&, int);
template ordered_json parsed_json(std::string_view);
template ordered_json own_json(std::string_view);
template std::string json_text(const ordered_json&, int);

}  // namespace sinew
