// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes as text and back: base64 (RFC 4648, padded, nothing between the digits), in parallel.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace sinew {

/// The characters that so many bytes become.
constexpr std::size_t base64_size(std::size_t bytes) {
  return bytes / 3 * 4 + (bytes % 3 > 0 ? 4 : 0);
}

/// The bytes that a text holds, going by its length and its padding.
std::size_t bytes_in_base64(std::string_view text);

/// The same text for any number of threads.
std::string base64(std::string_view bytes);

/// Puts `count` bytes at `to`; whether `text` is just what base64() makes of them.
bool from_base64(std::string_view text, std::size_t count, unsigned char* to);

}  // namespace sinew
