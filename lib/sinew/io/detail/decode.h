// SPDX-License-Identifier: GPL-3.0-or-later
// Decodes the data of an array in a VTK XML file, from any writer, to the array's bytes.
//
//     const std::optional<Decoded> values = decoded(element.text, {.base64 = true}, 12 * points);
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <sinew/core/options.h>

namespace sinew {

/// How a file encodes its arrays.
struct Coding {
  Encoding encoding = Encoding::zlib;  ///< what compresses them: zlib, lz4 or none
  bool base64 = true;                  ///< else raw
  std::size_t word = 8;                ///< bytes of each of the counts before the data: 4 or 8
};

/// An array's bytes: decoded ones of its own, or a view into the file where they are raw.
struct Decoded {
  std::vector<unsigned char> own;
  std::string_view bytes;
};

/// The bytes of the array that begins with `data`: nothing where the counts before them are not
/// those of `count` bytes, or where they are damaged. Allocates no more than valid data of that
/// length could hold.
std::optional<Decoded> decoded(std::string_view data, const Coding& coding, std::uint64_t count);

/// Maximal compression ratio of zlib, which is the larger of the two compressors'.
inline constexpr std::uint64_t max_expansion = 1032;

}  // namespace sinew
