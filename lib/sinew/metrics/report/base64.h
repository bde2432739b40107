// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as text a page can hold: base64 (RFC 4648) of their bytes, the lowest first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace sinew {

std::string base64(std::span<const std::uint8_t> bytes);

/// Of whole numbers of any width.
template <class Number>
std::string base64_of(const std::vector<Number>& numbers) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(numbers.size() * sizeof(Number));
  for (const Number number : numbers)
    for (std::size_t b = 0; b < sizeof(Number); ++b)
      bytes.push_back(
          static_cast<std::uint8_t>(static_cast<std::make_unsigned_t<Number>>(number) >> (8 * b)));
  return base64(bytes);
}

}  // namespace sinew
