// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstring>

#include <sinew/core/error.h>

namespace sinew::fuzz {

template <class Job>
void expect_sound_or_refused(Job&& job) {
  try {
    job();
  } catch (const Error& error) {
    require(error.exit() == Exit::bad_input && std::strstr(error.what(), "; ") != nullptr);
    require(is_one_line(error.what()));
  }
}

}  // namespace sinew::fuzz
