// SPDX-License-Identifier: GPL-3.0-or-later
// Texts for messages: the name that was probably meant, and foreign text made safe to print.
//
//     throw bad_input(shown(word) + " is no packing", suggestion(word, names));
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sinew {

/// The candidate closest to `word` (fewest letters inserted, deleted, replaced or swapped, ignoring
/// case), or "" when none is close: more than a third of the letters differ.
std::string nearest(std::string_view word, std::span<const std::string_view> candidates);

/// "did you mean NEAREST?", or "use one of a, b, c" when none is close.
std::string suggestion(std::string_view word, std::span<const std::string_view> candidates);

/// 'text' in quotes on one line, unprintable characters replaced, cut after 40 characters.
std::string shown(std::string_view text);

/// The text with '?' for each byte that is of no printable UTF-8 letter: control characters too,
/// which a terminal would obey.
std::string printable(std::string_view text);

/// The text as a shell reads it as one word: in quotes where it needs them, bytes that are not
/// printable as numbers, as bash and zsh read them.
std::string shell_quoted(std::string_view text);

/// ASCII capital letters become lower case.
std::string lower(std::string_view text);

/// "a, b, c"
std::string listed(std::span<const std::string_view> words);

/// "'a', 'b' and 5 more": at most eight of them, shown.
std::string some_shown(std::span<const std::string> names);

// Numbers as text, the same in every locale.

/// Shortest text that reads back as the same number.
std::string number_text(double value);

/// Three significant digits, for people: "0.00175".
std::string three_digits(double value);

/// A unit with a prefix of the SI, and what a number is divided by to be given in it.
struct PrefixedUnit {
  std::string unit;
  double size = 1;
};
/// The unit in which a number of that size is written in few digits: kPa for 2370 Pa. Units that
/// take no prefix, and numbers from 0.01 to 1000, keep theirs.
PrefixedUnit prefixed_unit(double value, const std::string& unit);
/// Three significant digits with it: "2.37 kPa".
std::string quantity_text(double value, const std::string& unit);

/// "12.3 MB", of bytes.
std::string bytes_text(double bytes);

}  // namespace sinew
