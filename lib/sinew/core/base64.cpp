// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/base64.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

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

/// One or two bytes; the padding is there.
void put_last(std::string_view rest, char* to) {
  const std::array<unsigned char, 3> last{static_cast<unsigned char>(rest[0]),
                                          static_cast<unsigned char>(rest.size() > 1 ? rest[1] : 0),
                                          0};
  std::array<char, 4> group;
  put_group(last.data(), group.data());
  std::copy_n(group.begin(), rest.size() > 1 ? 3 : 2, to);
}

/// Up to three bytes from `at` on, in part k and those behind it.
std::string bytes_across(const std::vector<std::string>& parts, std::size_t k, std::size_t at) {
  std::string bytes;
  for (; k < parts.size() && bytes.size() < 3; ++k, at = 0)
    bytes += parts[k].substr(at, 3 - bytes.size());
  return bytes;
}

/// The text of the groups of three bytes whose first one is in part k, which begins at `begin`.
std::string text_of_part(const std::vector<std::string>& parts, std::size_t k, std::size_t begin) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(parts[k].data());
  const std::size_t after = begin + parts[k].size(), first = (begin + 2) / 3;
  const std::size_t end = (after + 2) / 3, whole = std::max(first, after / 3);
  std::string text(4 * (end - first), '=');
  for (std::size_t group = first; group < whole; ++group)
    put_group(bytes + (3 * group - begin), &text[4 * (group - first)]);
  if (whole == end) return text;
  const std::string last = bytes_across(parts, k, 3 * whole - begin);
  char* to = &text[4 * (whole - first)];
  if (last.size() == 3)
    put_group(reinterpret_cast<const unsigned char*>(last.data()), to);
  else
    put_last(last, to);
  return text;
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

void put_base64(std::vector<std::string> parts,
                const std::function<void(std::size_t place, std::string_view piece)>& put) {
  std::size_t begin = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    put((begin + 2) / 3 * 4, text_of_part(parts, k, begin));
    begin += parts[k].size();
    parts[k] = std::string();
  }
}

std::string base64(std::string_view bytes) {
  const std::size_t whole = bytes.size() / 3;
  std::string text(base64_size(bytes.size()), '=');
  const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
  parallel_for(whole, groups_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) put_group(from + 3 * i, &text[4 * i]);
  });
  if (bytes.size() % 3 != 0) put_last(bytes.substr(3 * whole), &text[4 * whole]);
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
