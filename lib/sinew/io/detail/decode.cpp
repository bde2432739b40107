// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/detail/decode.h>

#include <libdeflate.h>
#include <lz4.h>
#include <algorithm>
#include <cstring>
#include <memory>
#include <new>

#include <sinew/core/base64.h>
#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t blocks_per_decompressor = 16;  // enough to amortize a decompressor of its own
constexpr std::uint64_t largest_block = std::uint64_t{1} << 30;  // below the limit of LZ4

class Decompressor {
 public:
  explicit Decompressor(Encoding encoding) : lz4_(encoding == Encoding::lz4) {
    if (!lz4_) zlib_.reset(libdeflate_alloc_decompressor());
    if (!lz4_ && !zlib_) throw std::bad_alloc();
  }

  /// Decompresses a block to `to`; whether it has `count` bytes.
  bool decompress(std::string_view block, unsigned char* to, std::size_t count) const {
    if (!lz4_)
      return libdeflate_zlib_decompress(zlib_.get(), block.data(), block.size(), to, count,
                                        nullptr) == LIBDEFLATE_SUCCESS;
    return block.size() <= LZ4_MAX_INPUT_SIZE &&
           LZ4_decompress_safe(block.data(), reinterpret_cast<char*>(to),
                               static_cast<int>(block.size()),
                               static_cast<int>(count)) == static_cast<int>(count);
  }

 private:
  struct Free {
    void operator()(libdeflate_decompressor* decompressor) const {
      libdeflate_free_decompressor(decompressor);
    }
  };
  bool lz4_;
  std::unique_ptr<libdeflate_decompressor, Free> zlib_;
};

Decoded owned(std::uint64_t count) {
  Decoded to;
  to.own.resize(count);
  to.bytes = {reinterpret_cast<const char*>(to.own.data()), to.own.size()};
  return to;
}

/// Takes `count` bytes, encoded separately, from the beginning of `data`.
std::optional<Decoded> take(std::string_view& data, const Coding& coding, std::uint64_t count) {
  if (count > data.size()) return std::nullopt;
  const std::size_t length = coding.base64 ? base64_size(count) : count;
  if (length > data.size()) return std::nullopt;
  const auto part = data.substr(0, length);
  data.remove_prefix(length);
  if (!coding.base64) return Decoded{{}, part};
  Decoded to = owned(count);
  if (!from_base64(part, count, to.own.data())) return std::nullopt;
  return to;
}

std::uint64_t word_at(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t word = 0;  // little endian, as everywhere in the file
  std::memcpy(&word, bytes.data() + at * size, size);
  return word;
}

/// Compressed blocks, all of `size` bytes but the last one.
struct Blocks {
  std::uint64_t size = 0;
  std::vector<std::uint64_t> starts{0};  ///< beginnings of blocks, end of the last one
};

/// Takes blocks by the counts before them: their number, their size, that of the last one if it is
/// shorter (else 0) and the compressed size of each.
std::optional<Blocks> take_blocks(std::string_view& data, const Coding& coding,
                                  std::uint64_t count) {
  auto ahead = data;
  const auto first = take(ahead, coding, 3 * coding.word);
  if (!first) return std::nullopt;
  const std::uint64_t blocks = word_at(first->bytes, 0, coding.word),
                      size = word_at(first->bytes, 1, coding.word),
                      last = word_at(first->bytes, 2, coding.word);
  if (size == 0 || size > largest_block || last > size) return std::nullopt;
  if (blocks == 0 || blocks > data.size()) return std::nullopt;
  const std::uint64_t full = last > 0 ? blocks - 1 : blocks;
  if (full > count / size || full * size + last != count) return std::nullopt;
  const auto words = take(data, coding, (3 + blocks) * coding.word);
  if (!words) return std::nullopt;
  Blocks found{size, {0}};
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::uint64_t packed = word_at(words->bytes, 3 + b, coding.word);
    if (packed > data.size() - found.starts.back()) return std::nullopt;
    found.starts.push_back(found.starts.back() + packed);
  }
  return found;
}

std::optional<Decoded> decompressed(std::string_view data, const Coding& coding,
                                    std::uint64_t count) {
  const auto blocks = take_blocks(data, coding, count);
  if (!blocks || count / max_expansion > blocks->starts.back()) return std::nullopt;
  const auto& starts = blocks->starts;
  const auto from = take(data, coding, starts.back());
  if (!from) return std::nullopt;
  Decoded to = owned(count);
  const auto damaged = [&](std::size_t begin, std::size_t end) {
    const Decompressor decompressor(coding.encoding);
    double number = 0;
    for (std::size_t b = begin; b < end; ++b) {
      const std::uint64_t at = b * blocks->size, size = std::min(blocks->size, count - at);
      const auto block = from->bytes.substr(starts[b], starts[b + 1] - starts[b]);
      number += decompressor.decompress(block, &to.own[at], size) ? 0 : 1;
    }
    return number;
  };
  if (parallel_sum(starts.size() - 1, blocks_per_decompressor, damaged) > 0) return std::nullopt;
  return to;
}

/// Data after the number of their bytes.
std::optional<Decoded> plain(std::string_view data, const Coding& coding, std::uint64_t count) {
  auto all = take(data, coding, coding.word + count);
  if (!all || word_at(all->bytes, 0, coding.word) != count) return std::nullopt;
  all->bytes.remove_prefix(coding.word);
  return all;
}

}  // namespace

std::optional<Decoded> decoded(std::string_view data, const Coding& coding, std::uint64_t count) {
  if (count == 0) return Decoded();
  const bool packed = coding.encoding == Encoding::zlib || coding.encoding == Encoding::lz4;
  return packed ? decompressed(data, coding, count) : plain(data, coding, count);
}

}  // namespace sinew
