// SPDX-License-Identifier: GPL-3.0-or-later
// The binary blocks of a VTK XML file begin with counts that VTK believes: sizes of what follows.
// Here they are checked against the bytes there are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace sinew {

/// zlib, the strongest of the usual compressors, packs at most 1032 bytes into one.
inline constexpr std::uint64_t most_expansion = 1032;

struct BlockCoding {
  bool base64 = true;
  bool compressed = false;
  bool big_endian = false;
  std::size_t word = 4;     ///< bytes per count: 4 (UInt32) or 8 (UInt64)
  std::uint64_t bytes = 0;  ///< of the whole file
};

/// The first `count` characters of a block, fewer where the file ends.
using BlockStart = std::function<std::string(std::size_t count)>;

struct BlockValues {
  std::size_t size = 1;  ///< bytes of each
  bool none = false;     ///< the file declares that there are none
};

/// Whether the counts of a block of these values can be true.
bool block_is_sound(const BlockStart& start, const BlockValues& values, const BlockCoding& coding);

}  // namespace sinew
