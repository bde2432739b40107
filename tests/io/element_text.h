// SPDX-License-Identifier: GPL-3.0-or-later
// The text of an array's element.
#pragma once

#include <algorithm>
#include <string>

#include <sinew/core/base64.h>
#include <sinew/io/detail/encode.h>

namespace sinew {

inline std::string element_text(const FileArray& array, Encoding encoding) {
  const EncodedArray encoded_array = encoded(array, 1, encoding);
  std::string text = encoded_array.counts;
  text.resize(encoded_array.text_size());
  put_base64(encoded_array.parts, [&](std::size_t place, std::string_view piece) {
    std::copy(piece.begin(), piece.end(),
              text.begin() + std::ptrdiff_t(encoded_array.counts.size() + place));
  });
  return text;
}

}  // namespace sinew
