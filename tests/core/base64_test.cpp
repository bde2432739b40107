// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/base64.h>

#include <gtest/gtest.h>
#include <random>

#include <sinew/core/parallel.h>

namespace sinew::base64_test {

std::string noise(std::size_t count) {
  std::mt19937 random(static_cast<unsigned>(count));
  std::string bytes(count, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random() % 256);
  return bytes;
}

bool is_base64(std::string_view text, std::size_t count) {
  std::vector<unsigned char> to(count + 1);
  return from_base64(text, count, to.data());
}

TEST(Base64, IsThatOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Base64, ComesBackForAnyNumberOfThreads) {
  for (const std::size_t count : {0, 1, 2, 3, 4, 5, 100, 1'000'003}) {
    const std::string bytes = noise(count), text = base64(bytes);
    EXPECT_EQ(text.size(), base64_size(count));
    EXPECT_EQ(bytes_in_base64(text), count);
    for (const int threads : {1, 3})
      with_threads(threads, [&] {
        EXPECT_EQ(base64(bytes), text);
        std::string back(count, 'x');
        EXPECT_TRUE(from_base64(text, count, reinterpret_cast<unsigned char*>(back.data())));
        EXPECT_EQ(back, bytes);
      });
  }
}

TEST(Base64, IsTakenOnlyAsItIsMade) {
  EXPECT_TRUE(is_base64("Zm9vYg==", 4));
  for (const char* text : {"Zm9vYg=A", "Zm9vYgA=", "Zm9vY===", "Zm9 Yg==", "=m9vYg==", "Zm9vYg",
                           "Zm9vYh==", "Zm9vYg==AAAA", "Zm9vYmE=", "", "Zm9vYg==\n"})
    EXPECT_FALSE(is_base64(text, 4)) << text;
  EXPECT_FALSE(is_base64("Zm9vYmF=", 5));
}

TEST(Base64, OfNoMeaningHoldsNoBytes) {
  for (const char* text : {"", "A", "AAA", "=", "=="}) EXPECT_EQ(bytes_in_base64(text), 0u) << text;
  EXPECT_EQ(bytes_in_base64("AAAAA"), 3u);
}

TEST(Base64, OfPartsIsThatOfTheirBytesHoweverTheyAreCut) {
  const std::string bytes = noise(61), text = base64(bytes);
  for (std::size_t part = 1; part <= bytes.size(); ++part) {
    std::vector<std::string> parts{""};
    for (std::size_t at = 0; at < bytes.size(); at += part) parts.push_back(bytes.substr(at, part));
    std::string joined;
    put_base64(parts, [&](std::size_t place, std::string_view piece) {
      EXPECT_EQ(place, joined.size());
      joined += piece;
    });
    EXPECT_EQ(joined, text) << part;
  }
}

}  // namespace sinew::base64_test
