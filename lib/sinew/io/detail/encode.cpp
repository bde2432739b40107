// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/detail/encode.h>

#include <libdeflate.h>
#include <lz4.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

#include <sinew/core/base64.h>
#include <sinew/core/parallel.h>

namespace sinew {

namespace {

// Files declare LittleEndian and hold the bytes as they are in memory.
static_assert(std::endian::native == std::endian::little);

constexpr std::size_t values_per_split = 4096;

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

/// Values are found in parts that stay in the cache, and converted.
template <class Stored, class T>
FileArray array_of(std::string_view type, const Computed<T>& values) {
  return {type, sizeof(Stored), values.count,
          [put = values.put](std::size_t begin, std::size_t end, unsigned char* to) {
            std::array<T, 512> part;
            for (std::size_t first = begin; first < end; first += part.size()) {
              const std::size_t last = std::min(end, first + part.size());
              put(first, last, part.data());
              for (std::size_t i = first; i < last; ++i, to += sizeof(Stored)) {
                const auto stored = static_cast<Stored>(part[i - first]);
                std::memcpy(to, &stored, sizeof stored);
              }
            }
          }};
}

template <class Stored>
ValueRange range_of_stored(const Stored* values, std::size_t count, std::size_t components) {
  ValueRange range;
  if constexpr (std::is_floating_point_v<Stored>)
    range.finite = std::all_of(values, values + count, [](Stored v) { return std::isfinite(v); });
  for (std::size_t i = 0; i < count; i += components) {
    auto value = static_cast<double>(values[i]);
    if (components > 1) {
      double squares = value * value;
      for (std::size_t k = 1; k < components; ++k)
        squares += static_cast<double>(values[i + k]) * static_cast<double>(values[i + k]);
      value = std::sqrt(squares);
    }
    if (value < range.low) range.low = value;  // false for not-a-number
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

FileArray float32_array(const Computed<double>& values) {
  return array_of<float>("Float32", values);
}

FileArray float64_array(const Computed<double>& values) {
  return array_of<double>("Float64", values);
}

FileArray int32_array(const Computed<std::int32_t>& values) {
  return array_of<std::int32_t>("Int32", values);
}

FileArray int32_array(std::size_t count, std::function<std::int32_t(std::size_t)> value) {
  return array_of<std::int32_t>("Int32", count, std::move(value));
}

FileArray bytes_array(std::size_t count, std::function<unsigned char(std::size_t)> value) {
  return array_of<unsigned char>("UInt8", count, std::move(value));
}

namespace {

void widen(ValueRange& range, const ValueRange& part) {
  range.low = std::min(range.low, part.low);
  range.high = std::max(range.high, part.high);
  range.finite = range.finite && part.finite;
}

ValueRange range_over(const std::vector<ValueRange>& parts) {
  ValueRange range;
  for (const ValueRange& part : parts) widen(range, part);
  return range;
}

/// Values [begin, end) of an array as stored, and those that complete the last row of components.
class StoredPiece {
 public:
  StoredPiece(const FileArray& array, std::size_t width) : array_(array), width_(width) {}

  void load(std::size_t begin, std::size_t end) {
    begin_ = begin, end_ = end;
    first_ = (begin + width_ - 1) / width_ * width_;
    last_ = std::max(first_, std::min(array_.count, (end + width_ - 1) / width_ * width_));
    values_.resize(((std::max(last_, end) - begin) * array_.size + sizeof(double) - 1) /
                   sizeof(double));
    array_.put(begin, std::max(last_, end), bytes());
  }
  unsigned char* bytes() { return reinterpret_cast<unsigned char*>(values_.data()); }
  std::size_t size() const { return (end_ - begin_) * array_.size; }  ///< size of [begin, end)
  /// Finds the range of the rows that begin in it.
  ValueRange range() {
    return range_of_bytes(bytes() + (first_ - begin_) * array_.size, last_ - first_, width_,
                          array_.type);
  }

 private:
  const FileArray& array_;
  std::size_t width_;
  std::size_t begin_ = 0, end_ = 0, first_ = 0, last_ = 0;
  std::vector<double> values_;  // for alignment
};

}  // namespace

ValueRange range_of(const FileArray& array, int components) {
  std::vector<ValueRange> parts((array.count + values_per_split - 1) / values_per_split);
  parallel_for(array.count, values_per_split, [&](std::size_t begin, std::size_t end) {
    StoredPiece piece(array, static_cast<std::size_t>(components));
    piece.load(begin, end);
    parts[begin / values_per_split] = piece.range();
  });
  return range_over(parts);
}

namespace {

constexpr std::size_t blocks_per_compressor = 16;  // enough to amortize a compressor of its own
constexpr int fastest = 1;  // slower levels do not compress floats of moving bodies better

class Compressor {
 public:
  explicit Compressor(Encoding encoding) : lz4_(encoding == Encoding::lz4) {
    if (!lz4_) zlib_.reset(libdeflate_alloc_compressor(fastest));
    if (!lz4_ && !zlib_) throw std::bad_alloc();
  }

  std::size_t most(std::size_t count) const {
    return lz4_ ? static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(count)))
                : libdeflate_zlib_compress_bound(zlib_.get(), count);
  }

  /// Returns the bytes written to `to`, which has space for most(count).
  std::size_t compress(const unsigned char* from, std::size_t count, char* to) const {
    if (!lz4_) return libdeflate_zlib_compress(zlib_.get(), from, count, to, most(count));
    return static_cast<std::size_t>(LZ4_compress_fast(reinterpret_cast<const char*>(from), to,
                                                      static_cast<int>(count),
                                                      static_cast<int>(most(count)), fastest));
  }

 private:
  struct Free {
    void operator()(libdeflate_compressor* compressor) const {
      libdeflate_free_compressor(compressor);
    }
  };
  bool lz4_;
  std::unique_ptr<libdeflate_compressor, Free> zlib_;
};

std::string bytes_of(const std::vector<std::uint64_t>& counts) {
  return {reinterpret_cast<const char*>(counts.data()), counts.size() * sizeof counts[0]};
}

/// Blocks [begin, end) one after the other; writes their sizes to `sizes`.
std::string compressed(const FileArray& array, std::size_t width, Encoding encoding,
                       std::size_t begin, std::size_t end, std::uint64_t* sizes,
                       ValueRange& range) {
  const Compressor compressor(encoding);
  const std::size_t values = block_bytes / array.size;
  StoredPiece block(array, width);
  const auto bytes =
      std::make_unique_for_overwrite<char[]>((end - begin) * compressor.most(block_bytes));
  std::size_t used = 0;
  for (std::size_t b = begin; b < end; ++b) {
    block.load(b * values, std::min(array.count, (b + 1) * values));
    sizes[b] = compressor.compress(block.bytes(), block.size(), bytes.get() + used);
    used += sizes[b];
    widen(range, block.range());
  }
  return {bytes.get(), used};
}

EncodedArray compressed(const FileArray& array, std::size_t width, Encoding encoding) {
  const std::size_t blocks = (array.bytes() + block_bytes - 1) / block_bytes;
  std::vector<std::uint64_t> counts{blocks, block_bytes, array.bytes() % block_bytes};
  counts.resize(3 + blocks);
  EncodedArray text;
  text.parts.resize((blocks + blocks_per_compressor - 1) / blocks_per_compressor);
  std::vector<ValueRange> ranges(text.parts.size());
  parallel_for(blocks, blocks_per_compressor, [&](std::size_t begin, std::size_t end) {
    const std::size_t part = begin / blocks_per_compressor;
    text.parts[part] = compressed(array, width, encoding, begin, end, &counts[3], ranges[part]);
  });
  text.range = range_over(ranges);
  text.counts = base64(bytes_of(counts));
  return text;
}

EncodedArray not_compressed(const FileArray& array, std::size_t width) {
  const std::size_t values = blocks_per_compressor * block_bytes / array.size;
  EncodedArray text;
  text.parts.resize(1 + (array.count + values - 1) / values);
  text.parts[0] = bytes_of({array.bytes()});
  std::vector<ValueRange> ranges(text.parts.size());
  parallel_for(array.count, values, [&](std::size_t begin, std::size_t end) {
    StoredPiece piece(array, width);
    piece.load(begin, end);
    const std::size_t part = 1 + begin / values;
    text.parts[part].assign(reinterpret_cast<const char*>(piece.bytes()), piece.size());
    ranges[part] = piece.range();
  });
  text.range = range_over(ranges);
  return text;
}

}  // namespace

std::size_t EncodedArray::text_size() const {
  std::size_t bytes = 0;
  for (const std::string& part : parts) bytes += part.size();
  return counts.size() + base64_size(bytes);
}

EncodedArray encoded(const FileArray& array, int components, Encoding encoding) {
  const auto width = static_cast<std::size_t>(components);
  const bool packed = encoding == Encoding::zlib || encoding == Encoding::lz4;
  return packed ? compressed(array, width, encoding) : not_compressed(array, width);
}

}  // namespace sinew
