// SPDX-License-Identifier: GPL-3.0-or-later
// The results of a command on standard output, as lines or JSON.
//
//     Results results;
//     results.add("radius", 0.01, "m");
//     results.print(common);
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/inspection/findings.h>

namespace sinew {

struct Common;

/// Collects named values in order and prints them: one "key: value" per line, or one JSON object.
class Results {
 public:
  /// A text, a number, a flag or a list; the unit is appended in lines only.
  void add(std::string key, nlohmann::ordered_json value, std::string unit = "");
  /// For lines only, where a key may occur twice, and for the object only.
  void add_line(std::string key, nlohmann::ordered_json value, std::string unit = "");
  void add_value(std::string key, nlohmann::ordered_json value);

  void add(const Findings& findings);

  /// A line in words, for people. Where there are any, other results are printed with --verbose and
  /// --json alone.
  void add_headline(std::string key, std::string words);
  std::vector<std::string> headlines() const;  ///< "key: words", in the object as summary

  /// "key: value" lines; briefly: the headlines alone, and numbers to four digits.
  std::string text(bool briefly = false) const;
  std::string json() const;  ///< one object; numbers that are not finite become null

  /// Prints text() or json(). Throws Error (not_written) where standard output fails.
  void print(const Common& common) const;

 private:
  enum class In { both, lines, object, headlines };
  struct Entry {
    std::string key, unit;
    nlohmann::ordered_json value;
    In in;
  };
  std::vector<Entry> entries_;
};

/// Writes to standard output and flushes it. Throws Error (not_written).
void print_out(std::string_view text);

/// Says a line for each warning.
void print_warnings(const std::vector<std::string>& warnings, const Common& common);

/// Writes a line to standard error, printable() but for its `colored` beginning.
void print_error(std::string_view line, std::string_view colored = "");

}  // namespace sinew
