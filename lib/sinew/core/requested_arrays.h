// SPDX-License-Identifier: GPL-3.0-or-later
// The arrays of particles that are written only when somebody asks for them.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace sinew {

/// All of them: F, J, stretch, strain, ...
std::span<const std::string_view> requestable_arrays();

/// Those that a text names, in the order of the table, each once: names with commas or spaces
/// between them, or "all". Throws bad input for any other, with the nearest name.
std::vector<std::string_view> requested_arrays(std::string_view words);

}  // namespace sinew
