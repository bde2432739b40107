// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/encode.h>

#include <libdeflate.h>
#include <lz4.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>

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

FileArray int32_array(std::size_t count, std::function<std::int32_t(std::size_t)> value) {
  return array_of<std::int32_t>("Int32", count, std::move(value));
}

FileArray bytes_array(std::size_t count, std::function<unsigned char(std::size_t)> value) {
  return array_of<unsigned char>("UInt8", count, std::move(value));
}

ValueRange range_of(const FileArray& array, int components) {
  const auto width = static_cast<std::size_t>(components);
  const std::size_t piece = values_per_split * width;
  std::vector<ValueRange> parts((array.count + piece - 1) / piece);
  parallel_for(array.count, piece, [&](std::size_t begin, std::size_t end) {
    // an array of doubles, for alignment
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

/// Appends blocks [begin, end); writes their sizes to `sizes`.
std::string compressed(const FileArray& array, Encoding encoding, std::size_t begin,
                       std::size_t end, std::uint64_t* sizes) {
  const Compressor compressor(encoding);
  const std::size_t values = block_bytes / array.size;
  std::vector<unsigned char> block(block_bytes);
  std::string bytes((end - begin) * compressor.most(block_bytes), '\0');
  std::size_t used = 0;
  for (std::size_t b = begin; b < end; ++b) {
    const std::size_t first = b * values, last = std::min(array.count, first + values);
    array.put(first, last, block.data());
    sizes[b] = compressor.compress(block.data(), (last - first) * array.size, &bytes[used]);
    used += sizes[b];
  }
  bytes.resize(used);
  return bytes;
}

std::string compressed_text(const FileArray& array, Encoding encoding) {
  const std::size_t blocks = (array.bytes() + block_bytes - 1) / block_bytes;
  std::vector<std::uint64_t> counts{blocks, block_bytes, array.bytes() % block_bytes};
  counts.resize(3 + blocks);
  std::vector<std::string> pieces((blocks + blocks_per_compressor - 1) / blocks_per_compressor);
  parallel_for(blocks, blocks_per_compressor, [&](std::size_t begin, std::size_t end) {
    pieces[begin / blocks_per_compressor] = compressed(array, encoding, begin, end, &counts[3]);
  });
  std::size_t total = 0;
  for (const std::string& piece : pieces) total += piece.size();
  std::string bytes;
  bytes.reserve(total);
  for (std::string& piece : pieces) {
    bytes += piece;
    piece = {};
  }
  return base64(bytes_of(counts)) + base64(bytes);
}

std::string plain_text(const FileArray& array) {
  std::string bytes = bytes_of({array.bytes()});
  bytes.resize(bytes.size() + array.bytes());
  auto* to = reinterpret_cast<unsigned char*>(bytes.data()) + sizeof(std::uint64_t);
  parallel_for(array.count, block_bytes, [&](std::size_t begin, std::size_t end) {
    array.put(begin, end, to + begin * array.size);
  });
  return base64(bytes);
}

}  // namespace

std::string element_text(const FileArray& array, Encoding encoding) {
  const bool packed = encoding == Encoding::zlib || encoding == Encoding::lz4;
  return packed ? compressed_text(array, encoding) : plain_text(array);
}

}  // namespace sinew
