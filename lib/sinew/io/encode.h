// SPDX-License-Identifier: GPL-3.0-or-later
// Encodes arrays for VTK's XML files: in blocks, compressed separately in parallel, after counts of
// 64 bits, as base64. The same bytes for any number of threads.
//
//     const std::string text = element_text(float64_array(values, count), Encoding::zlib);
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/options.h>

namespace sinew {

// Values in the file's number type, converted piece by piece from memory without a full copy.

struct FileArray {
  /// Writes values [begin, end) to `to`, in the file's type; called from several threads.
  using Put = std::function<void(std::size_t begin, std::size_t end, unsigned char* to)>;

  std::string_view type;  ///< VTK's name: "Float32"
  std::size_t size = 1;   ///< bytes of a value
  std::size_t count = 0;  ///< of values
  Put put;

  std::size_t bytes() const { return size * count; }
};

/// The values must outlive the array.
FileArray float32_array(const double* values, std::size_t count);
FileArray float64_array(const double* values, std::size_t count);
FileArray int32_array(const std::vector<std::int32_t>& values);
FileArray bytes_array(const std::string& bytes);

/// Computed whole numbers: value(i) for i < count.
FileArray int32_array(std::size_t count, std::function<std::int32_t(std::size_t)> value);
FileArray bytes_array(std::size_t count, std::function<unsigned char(std::size_t)> value);

/// Lowest and highest value as stored; of arrays with several components, of their magnitudes.
/// low > high where no value is a number.
struct ValueRange {
  double low = std::numeric_limits<double>::infinity(), high = -low;
};
ValueRange range_of(const FileArray& array, int components);

inline constexpr std::size_t block_bytes = 32768;  ///< as in VTK; fits into L1 caches

/// The text of a DataArray element of format "binary". Compressed (zlib, lz4): the number of
/// blocks, the bytes of a block, those of the last one where it is shorter (else 0) and the
/// compressed bytes of each; then, encoded separately, the blocks. Otherwise the number of bytes
/// and the bytes, encoded together.
std::string element_text(const FileArray& array, Encoding encoding);

}  // namespace sinew
