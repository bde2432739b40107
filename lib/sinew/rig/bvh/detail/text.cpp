// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/bvh/detail/text.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr double largest = 1e9;            // far larger than any body, and its square is finite
constexpr std::size_t longest_name = 200;  // bytes
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool is_mark(char c) { return c == '{' || c == '}' || c == ':'; }

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::size_t letter_size(unsigned first) {
  return first < 0x80 ? 1 : first < 0xC0 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
}

/// Removes a UTF-8 letter from the text; false where there is none (RFC 3629), or no printable one.
bool take_letter(std::string_view& text) {
  // Least letter by size; less is control, or written too long.
  constexpr std::uint32_t least[] = {0, 0x20, 0xA0, 0x800, 0x10000};
  const unsigned first = static_cast<unsigned char>(text[0]);
  const std::size_t size = letter_size(first);
  if (size == 0 || size > text.size()) return false;
  std::uint32_t letter = size == 1 ? first : first & (0x7Fu >> size);
  for (const char c : text.substr(1, size - 1)) {
    if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) return false;
    letter = letter << 6 | (static_cast<unsigned char>(c) & 0x3F);
  }
  text.remove_prefix(size);
  const bool surrogate = letter >= 0xD800 && letter <= 0xDFFF;
  return letter >= least[size] && letter != 0x7F && letter <= 0x10FFFF && !surrogate;
}

bool is_utf8(std::string_view text) {
  while (!text.empty())
    if (!take_letter(text)) return false;
  return true;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  return text;
}

/// Whether a number follows a plus.
bool follows_plus(std::string_view text) {
  return text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+';
}

bool too_small(std::string_view word) {
  const std::size_t exponent = word.find_first_of("eE");
  return exponent != word.npos && word.substr(exponent + 1, 1) == "-";
}

const char* cure_for(std::string_view word) {
  if (word.find(',') != word.npos) return "write a decimal point, and spaces between numbers";
  return "correct it, or export the file again";
}

}  // namespace

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

BvhText::BvhText(std::string file, std::string_view text) : file_(std::move(file)), text_(text) {
  if (text_.substr(0, byte_order_mark.size()) == byte_order_mark)
    at_ = start_ = byte_order_mark.size();
}

void BvhText::skip_space() {
  while (at_ < text_.size() && is_space(text_[at_])) ++at_;
}

bool BvhText::at_end() {
  skip_space();
  return at_ == text_.size();
}

std::string_view BvhText::peek() {
  skip_space();
  std::size_t end = at_;
  while (end < text_.size() && !is_space(text_[end]) && !is_mark(text_[end])) ++end;
  if (end == at_ && end < text_.size()) ++end;
  return text_.substr(at_, end - at_);
}

std::string_view BvhText::next() {
  const std::string_view word = peek();
  start_ = at_;
  at_ += word.size();
  return word;
}

bool BvhText::take(std::string_view word) {
  if (!same_word(peek(), word)) return false;
  next();
  return true;
}

void BvhText::expect(std::string_view word, const char* cure) {
  const std::string_view found = next();
  if (same_word(found, word)) return;
  std::string what = found.empty() ? "the file ends" : shown(found) + " is here";
  throw wrong(what + " where " + shown(word) + " belongs", cure);
}

std::string_view BvhText::name() {
  while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  if (at_ < text_.size() && (text_[at_] == '\n' || text_[at_] == '\r')) skip_space();
  start_ = at_;
  while (at_ < text_.size() &&
         std::string_view("\n\r{}").find(text_[at_]) == std::string_view::npos)
    ++at_;
  const std::string_view name = trimmed(text_.substr(start_, at_ - start_));
  check_name(name);
  return name;
}

void BvhText::check_name(std::string_view name) const {
  if (name.size() > longest_name)
    throw wrong("a name of " + std::to_string(name.size()) + " bytes, where " +
                    std::to_string(longest_name) + " are the most",
                "shorten it");
  if (!is_utf8(name))
    throw wrong("the name " + shown(name) + " is not UTF-8 text", "save the file as UTF-8");
}

double BvhText::number(const char* what) {
  skip_space();
  start_ = at_;
  const char* const end = text_.data() + text_.size();
  const char* begin = text_.data() + at_;
  if (follows_plus(rest())) ++begin;  // which from_chars does not accept
  double value = 0;
  const auto read = std::from_chars(begin, end, value);
  const bool whole =
      read.ptr != begin && (read.ptr == end || is_space(*read.ptr) || is_mark(*read.ptr));
  if (whole && read.ec == std::errc() && std::abs(value) <= largest) {
    at_ = static_cast<std::size_t>(read.ptr - text_.data());
    return value;
  }
  const std::string_view word = next();
  if (whole && read.ec == std::errc::result_out_of_range && too_small(word)) return 0;
  if (word.empty())
    throw wrong(std::string("the file ends where ") + what + " belongs", "complete it");
  const std::string found = shown(word) + ", given as " + what;
  if (!whole) throw wrong(found + ", is not a number", cure_for(word));
  if (!std::isfinite(value)) throw wrong(found + ", is not a finite number", cure_for(word));
  throw wrong(found + ", is larger than 1e9", cure_for(word));
}

std::int64_t BvhText::integer(const char* what) {
  const std::string_view word = next();
  if (word.empty())
    throw wrong(std::string("the file ends where ") + what + " belongs", "complete it");
  const std::string_view digits = word.substr(follows_plus(word) ? 1 : 0);
  std::int64_t value = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (read.ec == std::errc::result_out_of_range)
    throw wrong(shown(word) + ", given as " + what + ", is out of all range", "correct it");
  if (read.ec != std::errc() || read.ptr != digits.data() + digits.size())
    throw wrong(shown(word) + ", given as " + what + ", is not a whole number", "correct it");
  return value;
}

Place BvhText::place(std::size_t position) const {
  Place place = {file_, 1, 1};
  const std::size_t first = text_.substr(0, 3) == byte_order_mark ? 3 : 0;
  for (std::size_t i = first; i < position; ++i) {
    const bool ends = text_[i] == '\n' || (text_[i] == '\r' && text_.substr(i + 1, 1) != "\n");
    place.line += ends;
    place.column = ends ? 1 : place.column + 1;
  }
  return place;
}

Error BvhText::wrong(const std::string& what, const std::string& cure) const {
  return bad_input(place(), what, cure);
}

}  // namespace sinew
