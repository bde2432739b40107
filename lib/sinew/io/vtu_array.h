// SPDX-License-Identifier: GPL-3.0-or-later
// The arrays of a VTU file, of any type of numbers and in any of its formats, as our own.
#pragma once

#include <cstdint>
#include <string_view>

#include <sinew/core/dataset.h>
#include <sinew/core/error.h>
#include <sinew/io/decode.h>
#include <sinew/io/xml.h>

namespace sinew {

/// Where the arrays of a file are and how they are encoded.
struct VtuArrays {
  Coding within;              ///< the elements
  Coding behind;              ///< the elements, in the appended data
  std::string_view appended;  ///< from behind the '_'
  std::uint64_t most = 0;     ///< values that the file could hold

  /// Integers where all are Int32's, else doubles. Throws bad input naming the array where `rows`
  /// rows of numbers are not there.
  Column column(const XmlElement& array, std::uint64_t rows) const;
  Points points(const XmlElement& array, std::uint64_t rows) const;

  /// An attribute that counts, no more than that. Throws bad input.
  std::uint64_t count(const XmlElement& element, const char* attribute) const;
};

/// Bad input, with what helps.
Error vtu_refused(const std::string& what);

/// 'text', not too long.
std::string quoted(std::string_view text);

}  // namespace sinew
