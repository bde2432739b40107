// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cctype>
#include <cstring>

#include "core/error.h"

namespace sinew::fuzz {

template <class Job>
void expect_sound_or_refused(Job&& job) {
  try {
    job();
  } catch (const Error& error) {
    require(error.exit() == Exit::bad_input && std::strstr(error.what(), "; ") != nullptr);
    const char* end = error.what() + std::strlen(error.what());
    require(std::none_of(error.what(), end,
                         [](unsigned char c) { return c == '\n' || c == '\r' || c == 0x1b; }));
  }
}

}  // namespace sinew::fuzz
