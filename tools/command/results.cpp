// SPDX-License-Identifier: GPL-3.0-or-later
#include "command/results.h"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;

// File names may be in any encoding; JSON is UTF-8.
constexpr auto replace_wrong_bytes = Json::error_handler_t::replace;

std::string plain(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return number_text(value.get<double>());
  return value.dump(-1, ' ', false, replace_wrong_bytes);
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

std::string Results::text() const {
  std::string text;
  for (const Entry& one : entries_)
    if (one.in != In::object)
      text += one.key + ": " + plain(one.value) + (one.unit.empty() ? "" : ' ' + one.unit) + '\n';
  return text;
}

std::string Results::json() const {
  Json object = Json::object();
  for (const Entry& one : entries_)
    if (one.in != In::lines) object[one.key] = one.value;
  return object.dump(2, ' ', false, replace_wrong_bytes) + '\n';
}

void Results::print(bool as_json) const { print_out(as_json ? json() : text()); }

void print_out(const std::string& text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (std::fflush(stdout) == 0 && written) return;
  throw not_written("standard output",
                    "cannot be written (" + std::generic_category().message(errno) + ")",
                    "write to a disk with free space");
}

}  // namespace sinew
