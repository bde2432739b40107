// SPDX-License-Identifier: GPL-3.0-or-later
#include "results.h"

#include <cerrno>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/error.h"
#include "core/settings_table.h"

namespace sinew {
namespace {

struct Text {
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(double value) const { return number_text(value); }
  std::string operator()(const std::string& value) const { return value; }
};

}  // namespace

std::string Results::text() const {
  std::string text;
  for (const auto& [key, value] : values_) text += key + ": " + std::visit(Text{}, value) + '\n';
  return text;
}

std::string Results::json() const {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const auto& [key, value] : values_)
    std::visit([&, &name = key](const auto& given) { object[name] = given; }, value);
  // File names may be in any encoding; JSON is UTF-8.
  return object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

void Results::print(bool as_json) const { print_out(as_json ? json() : text()); }

void print_out(const std::string& text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (std::fflush(stdout) == 0 && written) return;
  throw not_written("standard output",
                    "cannot be written (" + std::generic_category().message(errno) + ")",
                    "send it to a place with space left");
}

}  // namespace sinew
