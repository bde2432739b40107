// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes as text and back: base64 (RFC 4648, padded, no characters between the digits), in parallel.
//
//     const std::string text = base64(bytes);
//     const bool valid = from_base64(text, bytes.size(), to);
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace sinew {

/// Characters that encode so many bytes.
constexpr std::size_t base64_size(std::size_t bytes) {
  return bytes / 3 * 4 + (bytes % 3 > 0 ? 4 : 0);
}

/// Bytes that a text encodes, by its length and its padding.
std::size_t bytes_in_base64(std::string_view text);

/// The same text for any number of threads.
std::string base64(std::string_view bytes);

/// The text of parts one after the other, in as many pieces; frees each part when it is text.
void put_base64(std::vector<std::string> parts,
                const std::function<void(std::size_t place, std::string_view piece)>& put);

/// Writes `count` bytes to `to`; whether `text` is exactly what base64() makes of them.
bool from_base64(std::string_view text, std::size_t count, unsigned char* to);

}  // namespace sinew
