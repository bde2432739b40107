// SPDX-License-Identifier: GPL-3.0-or-later
// What a command found out, on standard output.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sinew {

/// Collects values under names, in order, and prints them at the end: one "key: value" a line, or
/// one JSON object.
class Results {
 public:
  /// A text, a number, a flag or a list; the unit stands behind it for people.
  void add(std::string key, nlohmann::ordered_json value, std::string unit = "");
  /// For the lines alone, where a key may come twice, and for the object alone.
  void add_line(std::string key, nlohmann::ordered_json value, std::string unit = "");
  void add_value(std::string key, nlohmann::ordered_json value);

  std::string text() const;  ///< "key: value" lines
  std::string json() const;  ///< one object; numbers that are not finite become null

  /// Prints text() or json(). Throws Error (not_written) when standard output takes no more.
  void print(bool as_json) const;

 private:
  enum class In { both, lines, object };
  struct Entry {
    std::string key, unit;
    nlohmann::ordered_json value;
    In in;
  };
  std::vector<Entry> entries_;
};

/// Writes to standard output, and makes sure that it arrived. Throws Error (not_written).
void print_out(const std::string& text);

}  // namespace sinew
