// SPDX-License-Identifier: GPL-3.0-or-later
// What a user is told when something is wrong: one line, with all that it must name.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <sinew/core/error.h>

namespace sinew::test {

/// `job` must throw an Error of that exit code, whose one line holds all `parts`.
template <class Job>
void expect_error(Exit exit, Job&& job, const std::vector<std::string>& parts) {
  try {
    job();
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_EQ(error.exit(), exit) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    for (const std::string& part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << "no \"" << part << "\" in: " << text;
    return;
  }
  ADD_FAILURE() << "nothing was thrown";
}

template <class Job>
void expect_bad_input(Job&& job, const std::vector<std::string>& parts) {
  expect_error(Exit::bad_input, job, parts);
}

}  // namespace sinew::test
