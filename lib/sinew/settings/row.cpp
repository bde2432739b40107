// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/row.h>

#include <algorithm>
#include <array>
#include <cctype>

#include <sinew/core/text.h>

namespace sinew {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      out += std::string("\\x") + "0123456789abcdef"[byte >> 4] + "0123456789abcdef"[byte & 15];
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// Words that YAML, or a field, reads as something else than text; in lower case.
bool is_word(std::string text) {
  constexpr std::array<std::string_view, 11> words = {"true", "false", "null", "yes",  "no",  "on",
                                                      "off",  "y",     "n",    "auto", "none"};
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(words.begin(), words.end(), text) != words.end();
}

/// Whether YAML reads the text back as that very text without quotes.
bool plain(const std::string& text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_safe = [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '/' || c == '.' || c == '-';
  };
  const auto first = text.find_first_not_of("./");  // "../a" is plain, ".nan" is a number
  return first != std::string::npos && is_letter(text[first]) &&
         (first == 0 || text[first - 1] == '/') && !is_word(text) &&
         std::all_of(text.begin(), text.end(), is_safe);
}

std::string list_text(std::span<const double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "[" : ", ") + number_text(value);
  return text + ']';
}

std::string name_text(const std::string& text) { return plain(text) ? text : quoted(text); }

std::string pairs_text(const std::vector<NamePair>& pairs) {
  std::string text;
  for (const NamePair& pair : pairs)
    text += (text.empty() ? "[[" : ", [") + name_text(pair[0]) + ", " + name_text(pair[1]) + ']';
  return text + ']';
}

}  // namespace

std::string scene_text(const FieldValue& value, std::string_view absent) {
  if (const auto* number = std::get_if<double>(&value)) return number_text(*number);
  if (const auto* whole = std::get_if<int>(&value)) return std::to_string(*whole);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* text = std::get_if<std::string>(&value)) return name_text(*text);
  if (const auto* vector = std::get_if<Vec3>(&value)) return list_text({vector->data(), 3});
  if (const auto* list = std::get_if<std::vector<double>>(&value)) return list_text(*list);
  if (const auto* pairs = std::get_if<std::vector<NamePair>>(&value)) return pairs_text(*pairs);
  return std::string(absent);
}

}  // namespace sinew
