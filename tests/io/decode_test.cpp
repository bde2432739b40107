// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/detail/decode.h>

#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include <sinew/core/base64.h>
#include <sinew/core/parallel.h>
#include <sinew/io/detail/encode.h>
#include "element_text.h"

namespace sinew::decode_test {

constexpr Encoding in_elements[] = {Encoding::zlib, Encoding::lz4, Encoding::none};

std::string noise(std::size_t count) {
  std::mt19937 random(static_cast<unsigned>(count));
  std::string bytes(count, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random() % 7);
  return bytes;
}

std::string counts_of(const std::vector<std::uint32_t>& counts) {
  return {reinterpret_cast<const char*>(counts.data()), 4 * counts.size()};
}

TEST(Decoded, IsWhatWasEncoded) {
  for (const Encoding encoding : in_elements)
    for (const std::size_t count : {0, 1, 32767, 32768, 32769, 1'000'000}) {
      const std::string bytes = noise(count);
      const std::string text = element_text(bytes_array(bytes), encoding);
      for (const int threads : {1, 3})
        with_threads(threads, [&] {
          const auto back = decoded(text + "more", {encoding, true, 8}, count);
          ASSERT_TRUE(back) << count;
          EXPECT_TRUE(back->bytes == bytes) << count;
        });
    }
}

TEST(Decoded, IsNothingOfAnotherCountOrCoding) {
  const std::string bytes = noise(40000);
  for (const Encoding encoding : in_elements) {
    const std::string text = element_text(bytes_array(bytes), encoding);
    for (const std::uint64_t count : {std::uint64_t{39999}, std::uint64_t{40001},
                                      std::uint64_t{1} << 40, std::uint64_t{1} << 62})
      EXPECT_FALSE(decoded(text, {encoding, true, 8}, count)) << count;
    for (const Encoding other : in_elements)
      EXPECT_EQ(decoded(text, {other, true, 8}, bytes.size()).has_value(), other == encoding);
    EXPECT_FALSE(decoded(text, {encoding, true, 4}, bytes.size()));
    EXPECT_FALSE(decoded(text, {encoding, false, 8}, bytes.size()));
    EXPECT_FALSE(decoded(text.substr(0, text.size() - 1), {encoding, true, 8}, bytes.size()));
  }
}

TEST(Decoded, LiesInTheFileWhereItIsNotEncoded) {
  const std::string data = counts_of({5}) + "bytes and more";
  const auto bytes = decoded(data, {Encoding::none, false, 4}, 5);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(bytes->bytes, "bytes");
  EXPECT_EQ(bytes->bytes.data(), data.data() + 4);
  EXPECT_FALSE(decoded(data, {Encoding::none, false, 4}, 4));
  EXPECT_FALSE(decoded(data.substr(0, 8), {Encoding::none, false, 4}, 5));
}

TEST(Decoded, HasNoBlocksThatDoNotFit) {
  using Counts = std::vector<std::uint32_t>;
  constexpr std::uint32_t huge = ~std::uint32_t{0};
  for (const Counts& counts : {Counts{0, 8, 0},
                               {0, 8, 8},
                               {1, 0, 8},
                               {1, 8, 9},
                               {1, huge, 8},
                               {2, 8, 0, 1, 1},
                               {2, 8, 8, 1, 1},
                               {huge, 8, 0},
                               {1, 8, 0, huge},
                               {1, 8, 0, 100},
                               {1, 8, 0}})
    for (const bool base64_too : {false, true}) {
      const std::string text = counts_of(counts);
      EXPECT_FALSE(decoded(base64_too ? base64(text) + "AAAAAAAA" : text + "AAAAAAAA",
                           {Encoding::lz4, base64_too, 4}, 8));
    }
  // "12345678" by LZ4: nothing but literals.
  const std::string sound = counts_of({1, 8, 0, 9}) + "\x80" + "12345678";
  EXPECT_EQ(decoded(sound, {Encoding::lz4, false, 4}, 8)->bytes, "12345678");
}

TEST(Decoded, OfDamagedTextIsNeverTakenForOther) {  // zlib ends in a checksum of each block
  const std::string bytes = noise(40000);
  const std::string sound = element_text(bytes_array(bytes), Encoding::zlib);
  for (std::size_t at = 0; at < sound.size(); at += 97) {
    std::string text = sound;
    text[at] = text[at] == 'A' ? 'B' : 'A';
    const auto back = decoded(text, {Encoding::zlib, true, 8}, bytes.size());
    EXPECT_TRUE(!back || back->bytes == bytes) << at;
  }
}

}  // namespace sinew::decode_test
