// SPDX-License-Identifier: GPL-3.0-or-later
#include "command/results.h"

#include <fmt/format.h>
#include <array>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include <sinew/core/error.h>
#include <sinew/core/json.h>
#include <sinew/core/text.h>

#include "command/command.h"
#include "command/terminal.h"

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;

std::string four_digits(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

std::string plain(const Json& value, bool briefly) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float())
    return briefly ? four_digits(value.get<double>()) : number_text(value.get<double>());
  if (!briefly || !value.is_array()) return json_text(value);
  std::string list;
  for (const Json& one : value) {
    const std::string text =
        one.is_number_float() ? four_digits(one.get<double>()) : json_text(one);
    list += (list.empty() ? "" : ", ") + text;
  }
  return '[' + list + ']';
}

/// A value with its unit, which has a prefix where the number would have an exponent.
std::string with_unit(const Json& value, const std::string& unit, bool briefly) {
  std::string text = plain(value, briefly);
  if (unit.empty()) return text;
  if (!briefly || !value.is_number_float() || text.find('e') == std::string::npos)
    return text + ' ' + unit;
  const auto number = value.get<double>();
  const PrefixedUnit prefixed = prefixed_unit(number, unit);
  return four_digits(number / prefixed.size) + ' ' + prefixed.unit;
}

/// JSON escapes control characters but for 0x7f and those of 0x80 to 0x9f.
std::string without_terminal_controls(const std::string& json) {
  std::string text;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const bool pair = json[i] == '\xc2' && i + 1 < json.size();
    const auto code = static_cast<unsigned char>(json[pair ? i + 1 : i]);
    if (pair ? code < 0xa0 : code == 0x7f)
      text += fmt::format("\\u{:04x}", code), i += pair ? 1 : 0;
    else
      text += json[i];
  }
  return text;
}

}  // namespace

void Results::add(std::string key, Json value, std::string unit) {
  entries_.push_back({std::move(key), std::move(unit), std::move(value), In::both});
}

void Results::add_line(std::string key, Json value, std::string unit) {
  entries_.push_back({std::move(key), std::move(unit), std::move(value), In::lines});
}

void Results::add_value(std::string key, Json value) {
  entries_.push_back({std::move(key), "", std::move(value), In::object});
}

void Results::add(const Findings& findings) {
  for (const Finding& one : findings.all()) {
    const In in = one.in == ShownIn::both    ? In::both
                  : one.in == ShownIn::lines ? In::lines
                                             : In::object;
    entries_.push_back({one.key, one.unit, *one.value, in});
  }
}

void Results::add_headline(std::string key, std::string words) {
  entries_.push_back({std::move(key), "", std::move(words), In::headlines});
}

std::vector<std::string> Results::headlines() const {
  std::vector<std::string> lines;
  for (const Entry& one : entries_)
    if (one.in == In::headlines)
      lines.push_back((one.key.empty() ? "" : one.key + ": ") + one.value.get<std::string>());
  return lines;
}

std::string Results::text(bool briefly) const {
  const bool in_words = briefly && !headlines().empty();
  std::string text;
  if (in_words) {
    for (const std::string& line : headlines()) {
      const std::size_t key = line.find(": ") + 1;
      text += in_color(TextColor::bold, printable(line.substr(0, key)), stdout) +
              printable(line.substr(key)) + '\n';
    }
    return text;
  }
  for (const Entry& one : entries_)
    if (one.in != In::headlines && one.in != In::object)
      text += printable(one.key + ": " + with_unit(one.value, one.unit, briefly)) + '\n';
  return text;
}

std::string Results::json() const {
  Json object = Json::object();
  for (const Entry& one : entries_)
    if (one.in == In::both || one.in == In::object) object[one.key] = one.value;
  const std::vector<std::string> words = headlines();
  if (!words.empty()) object["summary"] = words;
  return without_terminal_controls(json_text(object, 2)) + '\n';
}

void Results::print(const Common& common) const {
  print_out(common.json ? json() : text(!common.verbose));
}

void print_warnings(const std::vector<std::string>& warnings, const Common& common) {
  for (const std::string& warning : warnings) say(common, "sinew: warning: " + warning);
}

void print_error(std::string_view line, std::string_view colored) {
  std::fprintf(stderr, "%.*s%s\n", static_cast<int>(colored.size()), colored.data(),
               printable(line).c_str());
}

void print_out(std::string_view text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (std::fflush(stdout) == 0 && written) return;
  throw not_written("standard output",
                    "cannot be written (" + std::generic_category().message(errno) + ")",
                    "write to a disk with free space");
}

}  // namespace sinew
