// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/base64.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t groups_per_piece = 1 << 17;
constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint32_t no_digit = 1 << 24;

using Pairs = std::array<std::array<char, 2>, 4096>;

/// The two digits of every 12 bits.
constexpr Pairs pairs_of_digits() {
  Pairs pairs{};
  for (std::size_t bits = 0; bits < pairs.size(); ++bits)
    pairs[bits] = {digits[bits >> 6], digits[bits & 63]};
  return pairs;
}

constexpr Pairs pairs = pairs_of_digits();

void put_group(const unsigned char* from, char* to) {
  std::memcpy(to, pairs[static_cast<std::size_t>(from[0] << 4 | from[1] >> 4)].data(), 2);
  std::memcpy(to + 2, pairs[static_cast<std::size_t>((from[1] & 15) << 8 | from[2])].data(), 2);
}

/// The bits of a digit at each of the four places of a group.
using Places = std::array<std::array<std::uint32_t, 256>, 4>;

constexpr Places places_of_digits() {
  Places places{};
  for (std::size_t place = 0; place < 4; ++place) {
    for (auto& bits : places[place]) bits = no_digit;
    for (std::uint32_t digit = 0; digit < 64; ++digit)
      places[place][static_cast<unsigned char>(digits[digit])] = digit << (18 - 6 * place);
  }
  return places;
}

constexpr Places places = places_of_digits();

/// The 24 bits of four digits; higher bits mark characters that are no digits.
std::uint32_t bits_of_group(const char* from) {
  std::uint32_t bits = 0;
  for (std::size_t place = 0; place < 4; ++place)
    bits |= places[place][static_cast<unsigned char>(from[place])];
  return bits;
}

void put_bytes(std::uint32_t bits, std::size_t count, unsigned char* to) {
  for (std::size_t byte = 0; byte < count; ++byte)
    to[byte] = static_cast<unsigned char>(bits >> (16 - 8 * byte));
}

bool put_whole_groups(const char* from, std::size_t count, unsigned char* to) {
  return parallel_sum(count, groups_per_piece, [&](std::size_t begin, std::size_t end) {
           std::uint32_t seen = 0;
           for (std::size_t i = begin; i < end; ++i) {
             const std::uint32_t bits = bits_of_group(from + 4 * i);
             seen |= bits;
             put_bytes(bits, 3, to + 3 * i);
           }
           return seen >= no_digit ? 1.0 : 0.0;
         }) == 0;
}

}  // namespace

std::size_t bytes_in_base64(std::string_view text) {
  const auto padding = static_cast<std::size_t>(text.ends_with('=')) + text.ends_with("==");
  return text.size() / 4 * 3 - std::min(padding, text.size() / 4 * 3);
}

std::string base64(std::string_view bytes) {
  const std::size_t whole = bytes.size() / 3, rest = bytes.size() % 3;
  std::string text(base64_size(bytes.size()), '=');
  const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
  parallel_for(whole, groups_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) put_group(from + 3 * i, &text[4 * i]);
  });
  if (rest == 0) return text;
  std::array<unsigned char, 3> last{};
  std::copy_n(from + 3 * whole, rest, last.begin());
  std::array<char, 4> group;
  put_group(last.data(), group.data());
  std::copy_n(group.begin(), rest + 1, &text[4 * whole]);
  return text;
}

bool from_base64(std::string_view text, std::size_t count, unsigned char* to) {
  if (text.size() != base64_size(count)) return false;
  const std::size_t whole = count / 3, rest = count % 3;
  if (!put_whole_groups(text.data(), whole, to)) return false;
  if (rest == 0) return true;
  std::array<char, 4> last{'A', 'A', 'A', 'A'};
  std::copy_n(&text[4 * whole], rest + 1, last.begin());
  const std::uint32_t bits = bits_of_group(last.data());
  put_bytes(bits, rest, to + 3 * whole);
  const std::uint32_t beyond = bits & (0xffffffu >> (8 * rest));
  return bits < no_digit && beyond == 0 &&
         text.substr(4 * whole + rest + 1) == (rest == 1 ? "==" : "=");
}

}  // namespace sinew
