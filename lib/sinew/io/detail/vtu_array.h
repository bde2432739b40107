// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the arrays of a VTU file, of any number type and in any of its formats.
//
//     const Column values = arrays.column(element, rows);
#pragma once

#include <cstdint>
#include <string_view>

#include <sinew/core/dataset.h>
#include <sinew/core/error.h>
#include <sinew/io/detail/decode.h>
#include <sinew/io/detail/xml.h>

namespace sinew {

/// Where the arrays of a file are and how they are encoded.
struct VtuArrays {
  Coding within;              ///< coding of data in the elements
  Coding behind;              ///< coding of data in the appended section
  std::string_view appended;  ///< data after the '_'
  std::uint64_t most = 0;     ///< values that the file could hold

  /// Integers where all fit Int32, else doubles. Throws bad input, naming the array, where it does
  /// not hold `rows` rows of numbers.
  Column column(const XmlElement& array, std::uint64_t rows) const;
  Points points(const XmlElement& array, std::uint64_t rows) const;

  /// An attribute that is a count, at most `most`. Throws bad input.
  std::uint64_t count(const XmlElement& element, const char* attribute) const;
};

/// Bytes of one value of an array. Throws bad input where it is not numeric.
std::size_t size_of_type(const XmlElement& array);

/// The error bad input, with the cure.
Error vtu_refused(const std::string& what);

/// 'text', shortened where it is long.
std::string quoted(std::string_view text);

}  // namespace sinew
