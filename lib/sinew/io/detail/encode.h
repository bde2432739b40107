// SPDX-License-Identifier: GPL-3.0-or-later
// Encodes arrays for VTK's XML files: in blocks, compressed separately in parallel, after counts of
// 64 bits, as base64. The same bytes for any number of threads.
//
//     const EncodedArray vectors = encoded(float64_array(values, count), 3, Encoding::zlib);
//     put_base64(vectors.parts, put);
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/dataset.h>
#include <sinew/core/options.h>

namespace sinew {

// Values in the file's number type, converted piece by piece from memory without a full copy.

struct FileArray {
  /// Writes values [begin, end) to `to`, in the file's type; called from several threads.
  using Put = std::function<void(std::size_t begin, std::size_t end, unsigned char* to)>;

  std::string_view type;  ///< VTK's name: "Float32"
  std::size_t size = 1;   ///< bytes of a value
  std::size_t count = 0;  ///< count of values
  Put put;

  std::size_t bytes() const { return size * count; }
};

/// The values must outlive the array.
FileArray float32_array(const double* values, std::size_t count);
FileArray float64_array(const double* values, std::size_t count);
FileArray int32_array(const std::vector<std::int32_t>& values);
FileArray bytes_array(const std::string& bytes);

FileArray float32_array(const Computed<double>& values);
FileArray float64_array(const Computed<double>& values);
FileArray int32_array(const Computed<std::int32_t>& values);

/// Whole numbers value(i) for i < count.
FileArray int32_array(std::size_t count, std::function<std::int32_t(std::size_t)> value);
FileArray bytes_array(std::size_t count, std::function<unsigned char(std::size_t)> value);

/// Lowest and highest value as stored; of arrays with several components, of their magnitudes.
/// low > high where no value is a number.
struct ValueRange {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool finite = true;  ///< every value, as stored
};
ValueRange range_of(const FileArray& array, int components);

inline constexpr std::size_t block_bytes = 32768;  ///< VTK's size; fits into L1 caches

/// The text of a DataArray element of format "binary": `counts`, then the base64 of the parts one
/// after the other. Compressed (zlib, lz4), the counts are the number of blocks, the bytes of a
/// block, those of the last one where it is shorter (else 0) and the compressed bytes of each, and
/// the parts are the blocks. Otherwise the number of bytes is the first part.
struct EncodedArray {
  ValueRange range;
  std::string counts;  ///< base64
  std::vector<std::string> parts;

  std::size_t text_size() const;
};

EncodedArray encoded(const FileArray& array, int components, Encoding encoding);

}  // namespace sinew
