// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays as VTK's XML files hold them: in blocks, compressed each by itself in parallel, behind
// counts of 64 bits, as base64. The same bytes for any number of threads.
#pragma once

#include <string>

#include "core/settings.h"
#include "io/file_array.h"

namespace sinew {

inline constexpr std::size_t block_bytes =
    32768;  ///< what VTK uses; it fits the caches of all cores
inline constexpr char base64_digits[] =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// The text within a DataArray element of format "binary". Compressed (zlib, lz4): the number of
/// blocks, the bytes of a block, those of the last one where it is shorter (else 0) and the
/// compressed bytes of each; then, encoded by themselves, the blocks. Otherwise the number of bytes
/// and the bytes, encoded as one.
std::string element_text(const FileArray& array, Encoding encoding);

/// The bytes in base64, padded.
std::string base64(const std::string& bytes);

}  // namespace sinew
