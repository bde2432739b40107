// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/xml_depth.h"

namespace sinew {
namespace {

constexpr int deepest = 32;

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

}  // namespace

bool nests_moderately(std::string_view xml) {
  int depth = 0;
  for (std::size_t at = xml.find('<'); at != xml.npos; at = xml.find('<', at)) {
    const char first = at + 1 < xml.size() ? xml[at + 1] : 0;
    if (first == '!') return false;
    const std::size_t end = end_of_tag(xml, at);
    const bool closed_at_once = end < xml.size() && xml[end - 1] == '/';
    if (first == '/')
      --depth;
    else if (first != '?' && !closed_at_once && ++depth > deepest)
      return false;
    at = end;
  }
  return true;
}

}  // namespace sinew
