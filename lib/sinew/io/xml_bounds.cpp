// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/xml_bounds.h>

#include <algorithm>

namespace sinew {
namespace {

constexpr int deepest = 32;
constexpr int most_elements = 200'000;
constexpr std::size_t longest_tag = 1 << 16, longest_entity = 16;  // bytes

/// The end of the tag that begins at `at`: its '>', quoted ones passed over.
std::size_t end_of_tag(std::string_view xml, std::size_t at) {
  char quote = 0;
  for (; at < xml.size(); ++at) {
    const char c = xml[at];
    if (quote != 0)
      quote = c == quote ? 0 : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '>')
      return at;
  }
  return at;
}

/// Whether all entities (&amp;) of a text end soon.
bool entities_are_short(std::string_view text) {
  for (auto at = text.find('&'); at != text.npos; at = text.find('&', at + 1))
    if (text.substr(at, longest_entity).find(';') == text.npos) return false;
  return true;
}

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r\n") == text.npos; }

}  // namespace

bool is_within_bounds(std::string_view xml) {
  int depth = 0, elements = 0;
  for (std::size_t text = 0; text < xml.size();) {
    const std::size_t tag = std::min(xml.find('<', text), xml.size());
    const std::string_view between = xml.substr(text, tag - text);
    if (depth > 0 ? !entities_are_short(between) : !is_blank(between)) return false;
    if (tag == xml.size()) break;
    const char first = tag + 1 < xml.size() ? xml[tag + 1] : 0;
    const std::size_t end = end_of_tag(xml, tag);
    if (first == '!' || end - tag > longest_tag) return false;
    if (first != '/' && ++elements > most_elements) return false;
    const bool closed_at_once = end < xml.size() && xml[end - 1] == '/';
    if (first == '/')
      --depth;
    else if (first != '?' && !closed_at_once && ++depth > deepest)
      return false;
    text = end + 1;
  }
  return true;
}

}  // namespace sinew
