// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/markup.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace sinew {
namespace {

std::string number(double value, std::chars_format format, int precision) {
  std::array<char, 400> text;  // a double has up to 309 digits before its decimal point
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, format, precision).ptr;
  return {text.data(), end};
}

std::string entity(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return {c};
  }
}

bool plain_in_links(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("-_.~/").find(c) != std::string_view::npos;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool control = static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\t';
    if (!control && c != 127) out += entity(c);
  }
  return out;
}

std::string inert(std::string json) {
  for (std::size_t at = json.find('<'); at != json.npos; at = json.find('<', at + 1))
    json.replace(at, 1, "\\u003c");
  return json;
}

std::string link_to(std::string_view path) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  path.remove_prefix(std::min(path.find_first_not_of('/'), path.size()));
  std::string out;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (plain_in_links(c))
      out += c;
    else
      out += {'%', digits[byte >> 4], digits[byte & 15]};
  }
  return out;
}

std::string element(std::string_view tag, const std::string& content, std::string_view attributes) {
  const std::string name(tag);
  const std::string space = attributes.empty() ? "" : " ";
  return '<' + name + space + std::string(attributes) + '>' + content + "</" + name + ">\n";
}

std::string row(const std::string& first, const std::vector<Cell>& cells) {
  std::string out = element("td", first);
  for (const Cell& cell : cells)
    out += element("td", escaped(cell.text),
                   "class=\"number\" data-label=\"" + escaped(cell.label) + '"');
  return element("tr", out);
}

std::string table(const std::vector<std::string_view>& columns, const std::string& rows) {
  std::string heads;
  for (const std::string_view column : columns)
    heads += element("th", escaped(column), heads.empty() ? "" : "class=\"number\"");
  return element("div",
                 element("table", element("thead", element("tr", heads)) + element("tbody", rows)),
                 "class=\"scrolls\" tabindex=\"0\"");
}

std::string readable(double value) {
  if (std::isnan(value)) return "–";
  if (value == 0) return "0";
  const double size = std::abs(value);
  if (!(size >= 1e-4 && size < 1e6)) return number(value, std::chars_format::scientific, 3);
  const int decimals = std::max(0, 3 - static_cast<int>(std::floor(std::log10(size))));
  std::string text = fixed(value, decimals);
  if (decimals > 0) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

std::string fixed(double value, int decimals) {
  return std::isnan(value) ? "–" : number(value, std::chars_format::fixed, decimals);
}

}  // namespace sinew
