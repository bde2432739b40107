// SPDX-License-Identifier: GPL-3.0-or-later
// Texts compared line by line with files that were looked at once. With SINEW_GOLDEN=update in the
// environment the files are written anew: look at what `git diff` shows of them.
#pragma once

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "support/scratch.h"
#include "support/source_dir.h"

namespace sinew::test {

/// Keeps the digits of a number that no rounding of another compiler or C library can touch.
inline std::string rounded(double value) {
  if (std::abs(value) < 1e-15) return "0";
  std::ostringstream text;
  text.precision(9);
  text << value;
  return text.str();
}

/// Compares with the file of that path below tests/, or writes it.
inline void expect_golden(const std::string& file, const std::string& text) {
  const auto path = std::filesystem::path(test::source_dir()) / "tests" / file;
  if (const char* wish = std::getenv("SINEW_GOLDEN"); wish && std::string(wish) == "update")
    put(path, text);
  std::istringstream found(text), expected(text_of(path));
  std::string line, golden;
  for (int number = 1; std::getline(expected, golden); ++number) {
    ASSERT_TRUE(std::getline(found, line)) << file << " ends before line " << number;
    ASSERT_EQ(line, golden) << file << ":" << number << " is not what it was; see golden.h";
  }
  ASSERT_FALSE(std::getline(found, line)) << file << " goes on with " << line;
}

}  // namespace sinew::test
