// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/detail/readers/mesh_text.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>

namespace sinew {
namespace {

bool blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r' && c != '\n'); }

std::string_view without_plus(std::string_view word) {
  const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-';
  return plus ? word.substr(1) : word;
}

}  // namespace

std::string_view Words::next() {
  std::size_t begin = 0;
  for (; begin < rest_.size() && (blank(rest_[begin]) || rest_[begin] == '\n'); ++begin)
    line_ += rest_[begin] == '\n';
  std::size_t end = begin;
  while (end < rest_.size() && !blank(rest_[end]) && rest_[end] != '\n') ++end;
  const std::string_view word = rest_.substr(begin, end - begin);
  rest_.remove_prefix(end);
  return word;
}

bool Lines::next() {
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  ++number_;
  return true;
}

std::optional<double> number_in(std::string_view word) {
  word = without_plus(word);
  double value = 0;
  const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || end != word.data() + word.size()) return std::nullopt;
  if (failure == std::errc::result_out_of_range)  // distinguishes overflow from underflow
    return std::strtod(std::string(word).c_str(), nullptr);
  return failure == std::errc() ? std::optional(value) : std::nullopt;
}

std::optional<std::int64_t> integer_in(std::string_view word) {
  word = without_plus(word);
  std::int64_t value = 0;
  const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || end != word.data() + word.size() || failure != std::errc())
    return std::nullopt;
  return value;
}

}  // namespace sinew
