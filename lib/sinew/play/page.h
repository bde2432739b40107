// SPDX-License-Identifier: GPL-3.0-or-later
// The page of a session: one file, which asks nobody but the session for anything.
#pragma once

#include <string>
#include <string_view>

namespace sinew {

/// UTF-8, with its style, script and libraries.
std::string play_page();

// The files in page/, which CMake embeds.
std::string_view play_style();
std::string_view play_script();
std::string_view play_markup();

}  // namespace sinew
