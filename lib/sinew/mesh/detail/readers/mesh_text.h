// SPDX-License-Identifier: GPL-3.0-or-later
// Words and numbers of a text, with their line numbers.
//
//     Words words("v 0 1 2");
//     const std::optional<double> x = number_in(words.next());
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace sinew {

/// The words of a text in order, across its lines.
class Words {
 public:
  explicit Words(std::string_view text, int line = 1) : rest_(text), line_(line) {}

  /// The next word, "" at the end.
  std::string_view next();

  /// The line of the last word returned.
  int line() const { return line_; }
  std::string_view rest() const { return rest_; }

  /// Goes to the end of the line.
  void skip_line() { rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size())); }

 private:
  std::string_view rest_;
  int line_;
};

/// The lines of a text without their ends.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  /// Goes to the next line; false when there is none.
  bool next();

  std::string_view line() const { return line_; }
  int number() const { return number_; }  ///< counts from 1
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_, line_;
  int number_ = 0;
};

/// The number that a word spells, including infinity and NaN; nothing where it is not a number.
std::optional<double> number_in(std::string_view word);
std::optional<std::int64_t> integer_in(std::string_view word);

}  // namespace sinew
