// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/requested_arrays.h>

#include <algorithm>
#include <array>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr std::array<std::string_view, 12> names = {
    "F",      "J",         "stretch", "strain",   "hencky_strain", "strain_eq",
    "stress", "von_mises", "D2min",   "turnover", "inverted",      "pose_error"};

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  constexpr std::string_view between = ", \t";
  for (auto at = text.find_first_not_of(between); at != text.npos;
       at = text.find_first_not_of(between, at)) {
    const auto end = std::min(text.find_first_of(between, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

}  // namespace

std::span<const std::string_view> requestable_arrays() { return names; }

std::vector<std::string_view> requested_arrays(std::string_view text) {
  const std::vector<std::string_view> words = words_of(text);
  const auto asked = [&](std::string_view name) {
    return std::find(words.begin(), words.end(), name) != words.end();
  };
  for (const std::string_view word : words)
    if (word != "all" && std::find(names.begin(), names.end(), word) == names.end())
      throw bad_input("there is no array " + shown(word) + " to ask for",
                      suggestion(word, names) + " (or all)");
  std::vector<std::string_view> found;
  for (const std::string_view name : names)
    if (asked(name) || asked("all")) found.push_back(name);
  return found;
}

}  // namespace sinew
