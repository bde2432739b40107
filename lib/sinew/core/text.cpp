// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/text.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

namespace sinew {

namespace {

constexpr std::size_t longest_word = 64;   // nobody misspells a longer one
constexpr std::size_t longest_shown = 40;  // keeps messages on one line of a terminal
constexpr std::string_view hexadecimal = "0123456789abcdef";

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// Letters to insert, delete, replace or swap with their neighbor to turn `a` into `b`.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = std::exchange(last, row);
  }
  return last[b.size()];
}

/// Like distance(), but a part of a name is close to the whole: step, time_step.
std::size_t strangeness(const std::string& word, const std::string& name) {
  const bool part = word.size() >= 3 && name.find(word) != std::string::npos;
  return part ? std::min<std::size_t>(1, distance(word, name)) : distance(word, name);
}

/// Bytes of the printable UTF-8 letter that `text` (not empty) begins with, 0 where there is none.
std::size_t letter_size(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return std::iscntrl(static_cast<int>(first)) ? 0 : 1;
  const std::size_t size = first < 0xC2   ? 0
                           : first < 0xE0 ? 2
                           : first < 0xF0 ? 3
                           : first < 0xF5 ? 4
                                          : 0;
  if (size == 0 || text.size() < size) return 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  // Control characters, overlong encodings, surrogates, beyond the last code point.
  const bool low = (first == 0xC2 && byte(1) < 0xA0) || (first == 0xE0 && byte(1) < 0xA0) ||
                   (first == 0xF0 && byte(1) < 0x90);
  const bool high = (first == 0xED && byte(1) > 0x9F) || (first == 0xF4 && byte(1) > 0x8F);
  return low || high ? 0 : size;
}

}  // namespace

std::string nearest(std::string_view word, std::span<const std::string_view> candidates) {
  if (word.size() > longest_word) return "";
  std::string_view best;
  std::size_t least = longest_word;
  for (const std::string_view candidate : candidates) {
    const std::size_t strange = strangeness(lower_case(word), lower_case(candidate));
    if (strange < least && strange <= std::max(word.size(), candidate.size()) / 3) {
      least = strange;
      best = candidate;
    }
  }
  return std::string(best);
}

std::string suggestion(std::string_view word, std::span<const std::string_view> candidates) {
  const std::string close = nearest(word, candidates);
  return close.empty() ? "use one of " + listed(candidates) : "did you mean " + close + "?";
}

std::string shown(std::string_view text) {
  std::string out = "'";
  for (std::size_t count = 0; !text.empty(); ++count) {
    if (count == longest_shown) return out + "...'";
    const std::size_t size = letter_size(text);
    out += size > 0 ? text.substr(0, size) : "?";
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return out + "'";
}

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t size = letter_size(text);
    out += size > 0 ? text.substr(0, size) : "?";
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return out;
}

std::string listed(std::span<const std::string_view> words) {
  std::string out;
  for (const std::string_view word : words) {
    if (!out.empty()) out += ", ";
    out += word;
  }
  return out;
}

std::string some_shown(std::span<const std::string> names) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
    text += (i > 0 ? ", " : "") + shown(names[i]);
  if (names.size() > most) text += " and " + std::to_string(names.size() - most) + " more";
  return text;
}

std::string shell_quoted(std::string_view text) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./,:=@%+-";
  if (!text.empty() && text.find_first_not_of(plain) == std::string_view::npos)
    return std::string(text);
  const bool as_it_is = printable(text) == text;
  std::string word = as_it_is ? "'" : "$'";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (as_it_is)
      word += c == '\'' ? "'\\''" : std::string(1, c);
    else if (byte < 0x20 || byte >= 0x7f || c == '\'' || c == '\\')
      word += {'\\', 'x', hexadecimal[byte / 16], hexadecimal[byte % 16]};
    else
      word += c;
  }
  return word + '\'';
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

std::string number_text(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

PrefixedUnit prefixed_unit(double value, const std::string& unit) {
  static constexpr std::array<std::string_view, 7> with_prefixes = {"Pa", "N", "J",  "W",
                                                                    "m",  "s", "m/s"};
  static constexpr std::array<std::string_view, 4> larger = {"k", "M", "G", "T"},
                                                   smaller = {"m", "µ", "n", "p"};
  const double size = std::abs(value) * (1 + 0.0005);  // 999.7 is 1.00 of the next
  if (!(size > 0) || !std::isfinite(size) || (size >= 0.01 && size < 1000) ||
      std::find(with_prefixes.begin(), with_prefixes.end(), unit) == with_prefixes.end())
    return {unit};
  const int power = std::clamp(static_cast<int>(std::floor(std::log10(size) / 3)), -4, 4);
  if (power == 0) return {unit};
  const auto place = static_cast<std::size_t>(std::abs(power) - 1);
  return {std::string(power > 0 ? larger[place] : smaller[place]) + unit, std::pow(1000, power)};
}

std::string quantity_text(double value, const std::string& unit) {
  const PrefixedUnit shown = prefixed_unit(value, unit);
  return three_digits(value / shown.size) + ' ' + shown.unit;
}

std::string bytes_text(double bytes) {
  constexpr std::array units = {"B", "kB", "MB", "GB", "TB", "PB", "EB"};
  double value = bytes;
  std::size_t unit = 0;
  for (; value >= 1000 && unit < 6; ++unit) value /= 1000;
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), unit == 0 ? "%.0f %s" : "%.1f %s", value, units[unit]);
  return text.data();
}

std::string three_digits(double value) {
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 3)
          .ptr;
  return {text.data(), end};
}

}  // namespace sinew
