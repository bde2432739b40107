// SPDX-License-Identifier: GPL-3.0-or-later
// JSON text from elsewhere and to elsewhere: its extent is found before it is parsed, as it may
// nest so deeply that reading its values exhausts the stack, or hold too many for the memory.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace sinew {

struct JsonExtent {
  int depth = 0;            ///< lists and objects inside each other
  std::int64_t values = 0;  ///< number of values, or one more
};

/// Measures any text; meaningful where it is JSON.
JsonExtent json_extent(std::string_view text);

// Json: nlohmann::json or nlohmann::ordered_json, whose parser and writer are compiled once, here.

/// The value of a JSON text; discarded where the text is none.
template <class Json>
Json parsed_json(std::string_view text);

/// The value of a JSON text that sinew wrote; discarded where the text is not JSON, or nested more
/// deeply than sinew nests.
template <class Json>
Json own_json(std::string_view text);

/// The text of a value; names of files in it may be in any encoding, JSON is UTF-8.
template <class Json>
std::string json_text(const Json& value, int indent = -1);

}  // namespace sinew
