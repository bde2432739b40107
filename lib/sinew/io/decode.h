// SPDX-License-Identifier: GPL-3.0-or-later
// Back from the text that encode.h makes of an array to its bytes, in parallel.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <sinew/core/options.h>

namespace sinew {

/// The bytes of which element_text made `text`: nothing where it made none such, or where they are
/// not as many as `count`. No more is allocated than a sound text of that length could hold.
std::optional<std::vector<unsigned char>> element_bytes(std::string_view text, Encoding encoding,
                                                        std::uint64_t count);

/// Puts `count` bytes at `to`; whether `text` is just what base64() makes of so many.
bool from_base64(std::string_view text, std::size_t count, unsigned char* to);

}  // namespace sinew
