// SPDX-License-Identifier: GPL-3.0-or-later
// What a command found out, on standard output.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace sinew {

using ResultValue = std::variant<bool, std::int64_t, double, std::string>;

/// Collects values under names, in order, and prints them at the end: one "key: value" a line, or
/// one JSON object.
class Results {
 public:
  void add(std::string key, bool value) { add_value(std::move(key), value); }
  void add(std::string key, int value) { add_value(std::move(key), std::int64_t{value}); }
  void add(std::string key, std::int64_t value) { add_value(std::move(key), value); }
  void add(std::string key, std::size_t value) {
    add_value(std::move(key), static_cast<std::int64_t>(value));
  }
  void add(std::string key, double value) { add_value(std::move(key), value); }
  void add(std::string key, const char* value) { add_value(std::move(key), std::string(value)); }
  void add(std::string key, std::string value) { add_value(std::move(key), std::move(value)); }

  std::string text() const;  ///< "key: value" lines
  std::string json() const;  ///< one object; numbers that are not finite become null

  /// Prints text() or json(). Throws Error (not_written) when standard output takes no more.
  void print(bool as_json) const;

 private:
  void add_value(std::string key, ResultValue value) {
    values_.emplace_back(std::move(key), std::move(value));
  }

  std::vector<std::pair<std::string, ResultValue>> values_;
};

/// Writes to standard output, and makes sure that it arrived. Throws Error (not_written).
void print_out(const std::string& text);

}  // namespace sinew
