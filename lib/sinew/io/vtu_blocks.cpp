// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/vtu_blocks.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

namespace sinew {
namespace {

using Words = std::vector<std::uint64_t>;

/// More than any writer uses (32 KiB by default), and small enough to allocate.
constexpr std::uint64_t largest_block = std::uint64_t{1} << 30;

/// The bytes of base64 text up to the first character that is none.
std::string decoded(const std::string& text) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    const auto digit = digits.find(c);
    if (digit == std::string_view::npos) break;
    bits = (bits << 6) | static_cast<std::uint32_t>(digit);
    if ((held += 6) < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> held & 255);
  }
  return bytes;
}

std::optional<Words> first_words(const BlockStart& start, std::size_t count,
                                 const BlockCoding& coding) {
  const std::size_t size = count * coding.word;
  const std::string bytes = coding.base64 ? decoded(start((size + 2) / 3 * 4)) : start(size);
  if (bytes.size() < size) return std::nullopt;
  Words words(count, 0);
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t place = i % coding.word;
    const std::size_t shift = coding.big_endian ? coding.word - 1 - place : place;
    words[i / coding.word] |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * shift);
  }
  return words;
}

/// Counts of compressed data: number of blocks, size of each, size of the last (0 when it is full),
/// then each block's compressed size.
bool compressed_is_sound(const BlockStart& start, const BlockValues& values,
                         const BlockCoding& coding) {
  const auto counts = first_words(start, 3, coding);
  if (!counts) return false;
  const std::uint64_t blocks = (*counts)[0], size = (*counts)[1], last = (*counts)[2];
  if (blocks > coding.bytes / coding.word || size > largest_block || last > size) return false;
  if (size == 0 || (blocks == 0 && !(values.none && last == 0))) return false;
  if (size % values.size != 0 || last % values.size != 0) return false;
  const std::uint64_t full = last > 0 ? blocks - 1 : blocks;
  if (full > most_expansion * coding.bytes / size) return false;
  const auto words = first_words(start, 3 + blocks, coding);
  if (!words) return false;
  std::uint64_t packed = 0;
  for (std::size_t i = 3; i < words->size(); ++i) {
    if ((*words)[i] > coding.bytes - packed) return false;
    packed += (*words)[i];
  }
  return true;
}

}  // namespace

bool block_is_sound(const BlockStart& start, const BlockValues& values, const BlockCoding& coding) {
  if (coding.compressed) return compressed_is_sound(start, values, coding);
  const auto counts = first_words(start, 1, coding);
  return counts && (*counts)[0] <= coding.bytes && (*counts)[0] % values.size == 0;
}

}  // namespace sinew
