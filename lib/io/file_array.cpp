// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/file_array.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/parallel.h"

namespace sinew {
namespace {

// Files say LittleEndian and hold the bytes as they stand in memory.
static_assert(std::endian::native == std::endian::little);

constexpr std::size_t values_per_piece = 4096;

template <class Stored, class Value>
FileArray array_of(std::string_view type, std::size_t count, Value value) {
  return {type, sizeof(Stored), count,
          [value = std::move(value)](std::size_t begin, std::size_t end, unsigned char* to) {
            for (std::size_t i = begin; i < end; ++i, to += sizeof(Stored)) {
              const auto stored = static_cast<Stored>(value(i));
              std::memcpy(to, &stored, sizeof stored);
            }
          }};
}

template <class Stored>
ValueRange range_of_stored(const Stored* values, std::size_t count, std::size_t components) {
  ValueRange range;
  for (std::size_t i = 0; i < count; i += components) {
    auto value = static_cast<double>(values[i]);
    if (components > 1) {
      double squares = value * value;
      for (std::size_t k = 1; k < components; ++k)
        squares += static_cast<double>(values[i + k]) * static_cast<double>(values[i + k]);
      value = std::sqrt(squares);
    }
    if (value < range.low) range.low = value;  // false for what is not a number
    if (value > range.high) range.high = value;
  }
  return range;
}

ValueRange range_of_bytes(const unsigned char* bytes, std::size_t count, std::size_t components,
                          std::string_view type) {
  if (type == "Float32")
    return range_of_stored(reinterpret_cast<const float*>(bytes), count, components);
  if (type == "Float64")
    return range_of_stored(reinterpret_cast<const double*>(bytes), count, components);
  if (type == "Int32")
    return range_of_stored(reinterpret_cast<const std::int32_t*>(bytes), count, components);
  return range_of_stored(bytes, count, components);
}

}  // namespace

FileArray float32_array(const double* values, std::size_t count) {
  return array_of<float>("Float32", count, [values](std::size_t i) { return values[i]; });
}

FileArray float64_array(const double* values, std::size_t count) {
  return array_of<double>("Float64", count, [values](std::size_t i) { return values[i]; });
}

FileArray int32_array(const std::vector<std::int32_t>& values) {
  return array_of<std::int32_t>("Int32", values.size(),
                                [first = values.data()](std::size_t i) { return first[i]; });
}

FileArray bytes_array(const std::string& bytes) {
  return array_of<unsigned char>("UInt8", bytes.size(),
                                 [first = bytes.data()](std::size_t i) { return first[i]; });
}

FileArray int32_array(std::size_t count, std::function<std::int32_t(std::size_t)> value) {
  return array_of<std::int32_t>("Int32", count, std::move(value));
}

FileArray bytes_array(std::size_t count, std::function<unsigned char(std::size_t)> value) {
  return array_of<unsigned char>("UInt8", count, std::move(value));
}

ValueRange range_of(const FileArray& array, int components) {
  const auto width = static_cast<std::size_t>(components);
  const std::size_t piece = values_per_piece * width;
  std::vector<ValueRange> parts((array.count + piece - 1) / piece);
  parallel_for(array.count, piece, [&](std::size_t begin, std::size_t end) {
    // of doubles, for their alignment
    std::vector<double> values(((end - begin) * array.size + sizeof(double) - 1) / sizeof(double));
    auto* bytes = reinterpret_cast<unsigned char*>(values.data());
    array.put(begin, end, bytes);
    parts[begin / piece] = range_of_bytes(bytes, end - begin, width, array.type);
  });
  ValueRange range;
  for (const ValueRange& part : parts) {
    range.low = std::min(range.low, part.low);
    range.high = std::max(range.high, part.high);
  }
  return range;
}

}  // namespace sinew
