// SPDX-License-Identifier: GPL-3.0-or-later
// Back from the data of an array in a VTK XML file, whoever wrote it, to the array's bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <sinew/core/options.h>

namespace sinew {

/// How a file keeps its arrays.
struct Coding {
  Encoding encoding = Encoding::zlib;  ///< what compresses them: zlib, lz4 or none
  bool base64 = true;                  ///< else as they are
  std::size_t word = 8;                ///< bytes of each of the counts before the data: 4 or 8
};

/// An array's bytes: its own, or those of the file where they lie there as they are.
struct Decoded {
  std::vector<unsigned char> own;
  std::string_view bytes;
};

/// The bytes of the array that begins with `data`: nothing where the counts before them are not
/// those of `count` bytes, or where they are damaged. No more is allocated than sound data of that
/// length could hold.
std::optional<Decoded> decoded(std::string_view data, const Coding& coding, std::uint64_t count);

/// zlib, the stronger of the compressors, packs at most 1032 bytes into one.
inline constexpr std::uint64_t most_expansion = 1032;

}  // namespace sinew
