// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/decode.h>

#include <libdeflate.h>
#include <lz4.h>
#include <algorithm>
#include <array>
#include <memory>
#include <new>

#include <sinew/core/parallel.h>
#include <sinew/io/encode.h>
#include <sinew/io/vtu_blocks.h>

namespace sinew {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::size_t blocks_per_piece = 16;  // enough to pay for a decompressor of its own
constexpr std::size_t groups_per_piece = 1 << 17;
constexpr std::uint32_t no_digit = 1 << 24;

/// The bits of a digit at each of the four places of a group.
using Places = std::array<std::array<std::uint32_t, 256>, 4>;

constexpr Places places_of_digits() {
  Places places{};
  for (int place = 0; place < 4; ++place) {
    for (auto& bits : places[place]) bits = no_digit;
    for (std::uint32_t digit = 0; digit < 64; ++digit)
      places[place][static_cast<unsigned char>(base64_digits[digit])] = digit << (18 - 6 * place);
  }
  return places;
}

constexpr Places places = places_of_digits();

/// The 24 bits of four digits; above them what is none.
std::uint32_t bits_of_group(const char* from) {
  std::uint32_t bits = 0;
  for (int place = 0; place < 4; ++place)
    bits |= places[place][static_cast<unsigned char>(from[place])];
  return bits;
}

bool whole_groups(const char* from, std::size_t count, unsigned char* to) {
  return parallel_sum(count, groups_per_piece, [&](std::size_t begin, std::size_t end) {
           std::uint32_t seen = 0;
           for (std::size_t i = begin; i < end; ++i) {
             const std::uint32_t bits = bits_of_group(from + 4 * i);
             seen |= bits;
             for (int byte = 0; byte < 3; ++byte)
               to[3 * i + byte] = static_cast<unsigned char>(bits >> (16 - 8 * byte));
           }
           return seen >= no_digit ? 1.0 : 0.0;
         }) == 0;
}

constexpr std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

class Decompressor {
 public:
  explicit Decompressor(Encoding encoding) : lz4_(encoding == Encoding::lz4) {
    if (!lz4_) zlib_.reset(libdeflate_alloc_decompressor());
    if (!lz4_ && !zlib_) throw std::bad_alloc();
  }

  /// Whether `size` bytes at `from` are `count` ones compressed, which are put at `to`.
  bool decompress(const unsigned char* from, std::size_t size, unsigned char* to,
                  std::size_t count) const {
    if (!lz4_)
      return libdeflate_zlib_decompress(zlib_.get(), from, size, to, count, nullptr) ==
             LIBDEFLATE_SUCCESS;
    return LZ4_decompress_safe(reinterpret_cast<const char*>(from), reinterpret_cast<char*>(to),
                               static_cast<int>(size),
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

/// Where each compressed block begins, and where the last one ends; nothing where the counts before
/// them are not those of `count` bytes.
std::optional<std::vector<std::uint64_t>> block_starts(std::string_view text, std::uint64_t count) {
  const std::uint64_t blocks = (count + block_bytes - 1) / block_bytes;
  if (blocks > text.size()) return std::nullopt;
  std::vector<std::uint64_t> counts(3 + blocks), starts{0};
  const std::size_t bytes = counts.size() * sizeof counts[0];
  if (!from_base64(text.substr(0, base64_size(bytes)), bytes,
                   reinterpret_cast<unsigned char*>(counts.data())))
    return std::nullopt;
  if (counts[0] != blocks || counts[1] != block_bytes || counts[2] != count % block_bytes)
    return std::nullopt;
  for (std::size_t b = 0; b < blocks; ++b) {
    if (counts[3 + b] > text.size()) return std::nullopt;
    starts.push_back(starts.back() + counts[3 + b]);
  }
  return starts;
}

std::optional<Bytes> decompressed(std::string_view text, Encoding encoding, std::uint64_t count) {
  const auto starts = block_starts(text, count);
  if (!starts) return std::nullopt;
  const std::size_t blocks = starts->size() - 1, size = starts->back();
  text.remove_prefix(base64_size((3 + blocks) * sizeof size));
  if (size > text.size() || count > size * most_expansion) return std::nullopt;
  Bytes from(size), to(count);
  if (!from_base64(text, size, from.data())) return std::nullopt;
  const double wrong =
      parallel_sum(blocks, blocks_per_piece, [&](std::size_t begin, std::size_t end) {
        const Decompressor decompressor(encoding);
        double damaged = 0;
        for (std::size_t b = begin; b < end; ++b) {
          const std::size_t at = b * block_bytes, start = (*starts)[b];
          if (!decompressor.decompress(&from[start], (*starts)[b + 1] - start, &to[at],
                                       std::min<std::size_t>(block_bytes, count - at)))
            ++damaged;
        }
        return damaged;
      });
  if (wrong > 0) return std::nullopt;
  return to;
}

std::optional<Bytes> plain(std::string_view text, std::uint64_t count) {
  if (count > text.size()) return std::nullopt;
  Bytes bytes(sizeof count + count);
  if (!from_base64(text, bytes.size(), bytes.data())) return std::nullopt;
  std::uint64_t told = 0;
  std::copy_n(bytes.begin(), sizeof told, reinterpret_cast<unsigned char*>(&told));
  if (told != count) return std::nullopt;
  bytes.erase(bytes.begin(), bytes.begin() + sizeof told);
  return bytes;
}

}  // namespace

bool from_base64(std::string_view text, std::size_t count, unsigned char* to) {
  if (text.size() != base64_size(count)) return false;
  const std::size_t whole = count / 3, rest = count % 3;
  if (!whole_groups(text.data(), whole, to)) return false;
  if (rest == 0) return true;
  std::array<char, 4> last{'A', 'A', 'A', 'A'};
  std::copy_n(&text[4 * whole], rest + 1, last.begin());
  const std::uint32_t bits = bits_of_group(last.data());
  for (std::size_t byte = 0; byte < rest; ++byte)
    to[3 * whole + byte] = static_cast<unsigned char>(bits >> (16 - 8 * byte));
  return bits < no_digit && text.substr(4 * whole + rest + 1) == (rest == 1 ? "==" : "=");
}

std::optional<Bytes> element_bytes(std::string_view text, Encoding encoding, std::uint64_t count) {
  if (encoding == Encoding::none) return plain(text, count);
  if (encoding == Encoding::raw) return std::nullopt;
  return decompressed(text, encoding, count);
}

}  // namespace sinew
