// SPDX-License-Identifier: GPL-3.0-or-later
// The arrays of particles that are written only on request.
//
//     for (const std::string_view name : requested_arrays("stretch, strain")) write(name);
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace sinew {

/// All of them: F, J, stretch, strain, ...
std::span<const std::string_view> requestable_arrays();

/// The names in a text, in the order of the table, each once: separated by commas or spaces, or
/// "all". Throws bad input for any other name, with the nearest one.
std::vector<std::string_view> requested_arrays(std::string_view words);

}  // namespace sinew
